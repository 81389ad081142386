// Springs against closed forms: extension, period, momentum.
#include "scenes.h"

#include "core/error.h"

#include "support/cloth_motion_cases.h"

#include <gtest/gtest.h>

namespace toile::bullet_cloth::test {
namespace {

TEST(ClothModel, MassIsDensityTimesArea) {
    const Mesh mesh = sheet({0, 0, 0}, {0.3f, 0, 0}, {0, 0.5f, 0}, 6, 10);
    Fabric fabric;
    fabric.density = 0.2f;
    const ClothModel model =
        make_cloth_model({mesh.positions, mesh.triangles, mesh.corner_coords, {}}, fabric, 4.0f);
    double mass = 0.0;
    for (const float m : model.mass) {
        mass += m;
    }
    EXPECT_NEAR(mass, 0.2 * 0.15, 1e-6);
    EXPECT_NEAR(model.area, 0.15, 1e-6);
}

TEST(ClothModel, LimitsReachFurtherThanOneEdgeAndAreNeverTooShort) {
    const Mesh mesh = sheet({0, 0, 0}, {0.4f, 0, 0}, {0, 0.4f, 0}, 20, 20);
    const ClothModel model =
        make_cloth_model({mesh.positions, mesh.triangles, mesh.corner_coords, {}}, Fabric{}, 4.0f);
    ASSERT_GT(model.limits.size(), mesh.positions.size());
    for (const LengthLimit& limit : model.limits) {
        const float straight = (mesh.positions[limit.a] - mesh.positions[limit.b]).norm();
        EXPECT_GE(limit.longest, straight - 1e-5f);
        EXPECT_LE(limit.longest, 1.09f * straight);
    }
}

// A strip of width w hanging from its top stretches by rho g L^2 / (2 K), whatever the width.
TEST(Springs, HangingStripStretchesByItsWeight) {
    for (const float stiffness : {15.0f, 30.0f}) {
        const Mesh mesh = sheet({0, -0.5f, 0}, {0.05f, 0, 0}, {0, 0.5f, 0}, 2, 20);
        Fabric fabric;
        fabric.density = 0.3f;
        fabric.stretch_warp = fabric.stretch_weft = stiffness;
        fabric.shear = 0.005f * stiffness;
        fabric.bend_warp = fabric.bend_weft = 0.0f;
        Settings settings = free_fall();
        settings.limit_edges = 0.0;
        settings.air_drag = 8.0;
        settings.substep_rate = 2500.0; // one pass a substep leaves some more, as h^2
        Stage stage(far_away(), mesh, settings, fabric, top_held(mesh, 2));
        for (int i = 0; i < 150; ++i) {
            ASSERT_EQ(stage.step(), StepResult::ok);
        }
        const float expected = 0.3f * 9.81f * 0.25f / (2.0f * stiffness);
        EXPECT_NEAR(-0.5f - stage.positions[1].y(), expected, 0.06f * expected) << stiffness;
    }
}

TEST(Springs, WarpAndWeftAreToldApart) {
    const Mesh mesh = sheet({0, 1, 0}, {0.05f, 0, 0}, {0, 0.5f, 0}, 2, 20);
    Fabric fabric;
    fabric.stretch_warp = 400.0f; // along v, which hangs
    fabric.stretch_weft = 20.0f;
    fabric.shear = 0.1f;
    fabric.bend_warp = fabric.bend_weft = 0.0f;
    Settings settings = free_fall();
    settings.limit_edges = 0.0;
    settings.air_drag = 8.0;
    settings.substep_rate = 4000.0;
    Stage along_warp(far_away(), mesh, settings, fabric, top_held(mesh, 2));
    std::swap(fabric.stretch_warp, fabric.stretch_weft);
    Stage along_weft(far_away(), mesh, settings, fabric, top_held(mesh, 2));
    for (int i = 0; i < 120; ++i) {
        along_warp.step();
        along_weft.step();
    }
    EXPECT_GT(1.0f - along_weft.positions[1].y(), 10.0f * (1.0f - along_warp.positions[1].y()));
}

TEST(Springs, MomentumIsKeptWithoutGravity) {
    const Mesh mesh = sheet({0, 1, 0}, {0.3f, 0, 0}, {0, 0.3f, 0}, 10, 10);
    Settings settings = free_fall();
    settings.gravity = 0.0;
    settings.damping_scale = 1.0;
    Stage stage(far_away(), mesh, settings);
    // Targets at rest, cloth thrown out of shape by starting from others.
    for (Vec3f& p : stage.targets) {
        p = Vec3f(1.04f * p.x(), p.y() + 0.1f * p.x() * p.x(), 0.1f * p.y());
    }
    stage.step(1.0 / 300.0);
    const auto momentum = [&] {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        const GarmentCloth& cloth = stage.world.garment(stage.handle);
        for (std::size_t v = 0; v < cloth.vertex_count(); ++v) {
            sum += cloth.model().mass[v] * cloth.velocities()[v].head<3>().cast<double>();
        }
        return sum;
    };
    double fastest = 0.0;
    for (int i = 0; i < 30; ++i) {
        stage.step();
        fastest = std::max(fastest, double(stage.root_mean_square_speed()));
        EXPECT_LT(momentum().norm(), 1e-5); // kg m/s, of 18 g
    }
    EXPECT_GT(fastest, 0.05); // it does move
}

} // namespace
} // namespace toile::bullet_cloth::test
