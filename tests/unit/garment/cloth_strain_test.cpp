// Stretched patches and bands, whose strain and pressure are known.
#include "garment/cloth_strain.h"

#include "core/error.h"
#include "support/garments.h"
#include "support/meshes.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::garment {
namespace {

std::vector<Vec2f> flat_coords(const geometry::TriangleMesh& mesh, double turn_rad = 0.0) {
    std::vector<Vec2f> out;
    const Eigen::Rotation2Df turn(static_cast<float>(turn_rad));
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t)
            out.push_back(turn * Vec2f(mesh.positions[v].head<2>()));
    return out;
}

ClothStrain strain_of_patch(const geometry::TriangleMesh& rest, double turn_rad, const Mat3f& map) {
    ClothStrain out(rest.triangles, flat_coords(rest, turn_rad), rest.positions.size());
    std::vector<Vec3f> now;
    for (const Vec3f& p : rest.positions)
        now.push_back(map * p + Vec3f(0.3f, 1.0f, -2.0f));
    out.measure(now);
    return out;
}

TEST(ClothStrain, OfAUniformStretchIsExactWhicheverWayThePatchLies) {
    const auto rest = test::grid(0.3f, 0.2f, 6, 5);
    const Mat3f stretch = Vec3f(1.10f, 0.95f, 1.0f).asDiagonal();
    const Mat3f turned = Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()).toRotationMatrix();
    const ClothStrain strain = strain_of_patch(rest, 0.0, turned * stretch);
    for (std::size_t v = 0; v < rest.positions.size(); ++v) {
        EXPECT_NEAR(strain.weft()[v], 0.10f, 1e-5f);
        EXPECT_NEAR(strain.warp()[v], -0.05f, 1e-5f);
    }
    const StrainFigures figures = strain.figures();
    EXPECT_NEAR(figures.max, 0.10, 1e-5);
    EXPECT_NEAR(figures.rms, std::sqrt(0.5 * (0.01 + 0.0025)), 1e-5);
    EXPECT_NEAR(figures.rest_area, 0.06, 1e-6);
}

TEST(ClothStrain, OnTheBiasBothThreadsShareTheStretch) {
    // Threads at 45 degrees to a stretch s along x: both are |(s, 1)| / sqrt 2 long.
    const auto rest = test::grid(0.3f, 0.2f, 6, 5);
    const Mat3f stretch = Vec3f(1.2f, 1.0f, 1.0f).asDiagonal();
    const ClothStrain strain = strain_of_patch(rest, 0.25 * std::numbers::pi, stretch);
    const auto expected = static_cast<float>(std::sqrt(0.5 * (1.44 + 1.0)) - 1.0);
    for (std::size_t i = 0; i < rest.triangles.size(); ++i) {
        EXPECT_NEAR(strain.triangle_warp()[i], expected, 1e-5f);
        EXPECT_NEAR(strain.triangle_weft()[i], expected, 1e-5f);
    }
}

TEST(ClothStrain, MovedRigidlyThereIsNone) {
    const auto rest = test::grid(0.3f, 0.2f, 6, 5);
    const Mat3f turned = Eigen::AngleAxisf(2.0f, Vec3f::UnitY()).toRotationMatrix();
    EXPECT_LT(strain_of_patch(rest, 0.4, turned).figures().max, 1e-5);
}

/// A band of rest radius 0.10 m on a cylinder of another; the ring's normals.
struct Band {
    GarmentSize size = test::tube_size("M", 0.10f, 0.5f, 0.6f, 48, 6);
    std::vector<Vec3f> positions, normals;
    ClothStrain strain{size.simulation.triangles, size.material_coords,
                       size.simulation.positions.size()};

    explicit Band(float radius) {
        for (const Vec3f& p : size.simulation.positions) {
            normals.push_back(Vec3f(p.x(), 0.0f, p.z()).normalized());
            positions.push_back(radius * normals.back() + Vec3f(0.0f, p.y(), 0.0f));
        }
        strain.measure(positions);
        strain.measure_pressure(positions, normals, {500.0, 200.0});
    }
};

TEST(ClothStrain, AStretchedBandPressesWithTensionOverRadius) {
    for (const float radius : {0.105f, 0.12f}) {
        const Band band(radius);
        const float stretch = radius / 0.10f - 1.0f;
        const float expected = 200.0f * stretch / radius; // Laplace, weft runs around
        for (const float pressure : band.strain.pressure())
            EXPECT_NEAR(pressure, expected, 1e-3f * expected);
    }
}

TEST(ClothStrain, ABandThatIsTooWideDoesNotPress) {
    const Band band(0.09f);
    for (const float pressure : band.strain.pressure())
        EXPECT_EQ(pressure, 0.0f);
    EXPECT_EQ(band.strain.figures().max, std::max(0.0, band.strain.figures().max));
    EXPECT_NEAR(band.strain.weft()[0], -0.1f, 1e-4f);
}

TEST(ClothStrain, ClothWithoutARestStateIsRefused) {
    const auto mesh = test::grid(0.3f, 0.2f, 2, 2);
    std::vector<Vec2f> coords = flat_coords(mesh);
    EXPECT_THROW(ClothStrain(mesh.triangles, std::span(coords).first(3), mesh.positions.size()),
                 Error);
    coords[1] = coords[2] = coords[0];
    EXPECT_THROW(ClothStrain(mesh.triangles, coords, mesh.positions.size()), Error);
    EXPECT_THROW(ClothStrain(mesh.triangles, flat_coords(mesh), 3), Error);
}

} // namespace
} // namespace toile::garment
