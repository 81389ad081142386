#include "geometry/surface_walk.h"

#include "core/error.h"
#include "support/meshes.h"

#include <gtest/gtest.h>
#include <random>

namespace toile::geometry {
namespace {

std::vector<Vec4f> rows(std::span<const Vec3f> points) {
    std::vector<Vec4f> out;
    for (const Vec3f& p : points)
        out.emplace_back(p.x(), p.y(), p.z(), 0.0f);
    return out;
}

// An open tube: walls, and borders at both ends.
struct Tube {
    TriangleMesh mesh = test::tube(0.2f, 0.2f, 0.5f, 32, 16);
    std::vector<Vec4f> positions = rows(mesh.positions);
    SurfaceWalk walk{mesh.triangles, mesh.positions.size()};
    NearestSurface nearest{mesh.positions, mesh.triangles};
};

TEST(SurfaceWalk, FindsTheNearestPointFromNearby) {
    const Tube tube;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> amount(-1.0f, 1.0f);
    std::uint32_t from = 0;
    Vec3f p = Vec3f(0.2f, 0.25f, 0.0f);
    for (int step = 0; step < 2000; ++step) {
        // Outside the tube and over its borders, a centimetre at a time. (Inside, a facet's ridge
        // can stop a descent a little early.)
        p += 0.01f * Vec3f(amount(random), amount(random), amount(random));
        const float out = Vec2f(p.x(), p.z()).norm();
        const float kept = std::clamp(out, 0.201f, 0.25f) / out;
        p = Vec3f(kept * p.x(), std::clamp(p.y(), -0.05f, 0.55f), kept * p.z());
        const WalkPoint found = tube.walk.walk(tube.positions, {p.x(), p.y(), p.z(), 0.0f}, from);
        ASSERT_NE(found.triangle, kNoTriangle);
        from = found.triangle;
        const float truth = tube.nearest.nearest(p).distance;
        ASSERT_NEAR(std::sqrt(found.squared), truth, 1e-5f) << "step " << step;
        ASSERT_NEAR((found.point.head<3>() - p).norm(), std::sqrt(found.squared), 1e-6f);
        ASSERT_NEAR(found.bary[0] + found.bary[1] + found.bary[2], 1.0f, 1e-5f);
    }
}

TEST(SurfaceWalk, StaysInItsGroups) {
    const Tube tube;
    std::vector<std::uint8_t> groups(tube.mesh.triangles.size());
    std::uint32_t start = 0;
    for (std::uint32_t t = 0; t < groups.size(); ++t) {
        groups[t] = tube.mesh.positions[tube.mesh.triangles[t][0]].x() > 0.0f ? 1 : 2;
        start = groups[t] == 1 ? t : start;
    }
    const SurfaceWalk walk(tube.mesh.triangles, tube.mesh.positions.size(), groups);
    const Vec4f far(-0.3f, 0.25f, 0.02f, 0.0f);
    EXPECT_EQ(groups[walk.walk(tube.positions, far, start, 1u << 1).triangle], 1);
    EXPECT_EQ(groups[walk.walk(tube.positions, far, start).triangle], 2);
}

TEST(SurfaceWalk, NeighboursAndBorders) {
    const Tube tube;
    std::size_t borders = 0;
    for (std::uint32_t t = 0; t < tube.mesh.triangles.size(); ++t) {
        for (std::size_t side = 0; side < 3; ++side) {
            const std::uint32_t next = tube.walk.across(t, side);
            borders += next == kNoTriangle ? 1 : 0;
            if (next != kNoTriangle) {
                EXPECT_TRUE(tube.walk.across(next, 0) == t || tube.walk.across(next, 1) == t ||
                            tube.walk.across(next, 2) == t);
            }
        }
    }
    EXPECT_EQ(borders, check_topology(tube.mesh.positions, tube.mesh.triangles).boundary_edges);
}

TEST(SurfaceWalk, APointThatIsNotFiniteIsNowhere) {
    const Tube tube;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(tube.walk.walk(tube.positions, {nan, 0, 0, 0}, 0).triangle, kNoTriangle);
}

TEST(SurfaceWalk, RefusesWhatDoesNotFit) {
    const std::vector<Triangle> triangles{{0, 1, 3}};
    EXPECT_THROW(SurfaceWalk(triangles, 3), Error);
    const std::vector<std::uint8_t> groups{0, 1};
    EXPECT_THROW(SurfaceWalk(triangles, 4, groups), Error);
}

} // namespace
} // namespace toile::geometry
