#include "simulated_sensor/breath.h"

#include "support/meshes.h"

#include <gtest/gtest.h>

namespace toile::simulated_sensor {
namespace {

/// A trunk from y = 1 to y = 2 with its labels.
struct Trunk {
    geometry::TriangleMesh mesh = test::sphere(0.5f, 4);
    std::vector<body::Part> parts;
    body::Skeleton skeleton;

    Trunk() {
        for (Vec3f& p : mesh.positions)
            p.y() += 1.5f;
        parts.assign(mesh.positions.size(), body::Part::torso);
        skeleton.rest_positions[static_cast<std::size_t>(body::Joint::hips)] = {0.0f, 1.0f, 0.0f};
        skeleton.rest_positions[static_cast<std::size_t>(body::Joint::neck)] = {0.0f, 2.0f, 0.0f};
    }
    /// How far the vertices have moved outwards at a time.
    [[nodiscard]] std::vector<float> rise(double most_m, double time_s) const {
        Breath breath(most_m, mesh, parts, skeleton);
        std::vector<Vec3f> moved = mesh.positions;
        breath.move(time_s, mesh.triangles, moved);
        std::vector<float> out;
        for (std::size_t v = 0; v < moved.size(); ++v)
            out.push_back((moved[v] - Vec3f(0.0f, 1.5f, 0.0f)).norm() - 0.5f);
        return out;
    }
};

TEST(Breath, RisesAtTheChestAndComesBack) {
    const Trunk trunk;
    const auto start = trunk.rise(0.01, 0.0), half = trunk.rise(0.01, 2.0),
               whole = trunk.rise(0.01, 4.0);
    float highest = 0.0f;
    for (std::size_t v = 0; v < half.size(); ++v) {
        EXPECT_NEAR(start[v], 0.0f, 1e-6f);
        EXPECT_NEAR(whole[v], 0.0f, 1e-6f);
        EXPECT_GE(half[v], -1e-6f);
        highest = std::max(highest, half[v]);
        if (trunk.mesh.positions[v].y() < 1.05f) EXPECT_LT(half[v], 0.001f);
    }
    EXPECT_NEAR(highest, 0.01f, 0.002f); // the falling off is softened
}

TEST(Breath, LeavesTheRestOfTheBody) {
    Trunk trunk;
    trunk.parts.assign(trunk.parts.size(), body::Part::left_upper_arm);
    for (const float moved : trunk.rise(0.01, 2.0))
        EXPECT_NEAR(moved, 0.0f, 1e-6f);
}

TEST(Breath, NoneIsAsked) {
    for (const float moved : Trunk().rise(0.0, 2.0))
        EXPECT_NEAR(moved, 0.0f, 1e-6f);
}

} // namespace
} // namespace toile::simulated_sensor
