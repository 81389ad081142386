// Sheets whose crossings are known.
#include "geometry/self_intersection.h"

#include "core/error.h"
#include "support/meshes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace toile::geometry {
namespace {

/// Two sheets as one mesh.
TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
    const auto base = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const Triangle& t : b.triangles)
        a.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    return a;
}

std::ptrdiff_t cut(const TriangleMesh& mesh) {
    const auto found = self_intersecting(mesh.positions, mesh.triangles);
    EXPECT_EQ(found.size(), mesh.triangles.size());
    return std::count(found.begin(), found.end(), 1);
}

// A sheet in z = 0, and one across it in a plane x = 0.35 that reaches from z = -0.5 to 0.5 and
// from y = 0.03 to y = 0.97: it passes through the squares of one column, rows 0 to 9.
TEST(SelfIntersection, CountsTheTrianglesAlongACrossing) {
    const TriangleMesh flat = test::grid(1.0f, 1.0f, 10, 10);
    TriangleMesh upright = test::grid(1.0f, 0.94f, 1, 1);
    for (Vec3f& p : upright.positions)
        p = Vec3f(0.35f, p.y() + 0.03f, p.x() - 0.5f);
    const TriangleMesh mesh = both(flat, upright);
    const auto found = self_intersecting(mesh.positions, mesh.triangles);
    for (std::size_t i = 0; i < flat.triangles.size(); ++i) {
        float low = 1.0f, high = 0.0f;
        for (const std::uint32_t v : flat.triangles[i]) {
            low = std::min(low, flat.positions[v].x());
            high = std::max(high, flat.positions[v].x());
        }
        EXPECT_EQ(found[i] != 0, low < 0.35f && high > 0.35f) << i;
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), 20 + 2);
}

TEST(SelfIntersection, SheetsApartAndNeighboursAreNotCut) {
    EXPECT_EQ(cut(test::sphere(0.3f, 3)), 0);
    TriangleMesh above = test::grid(1.0f, 1.0f, 7, 7);
    for (Vec3f& p : above.positions)
        p.z() = 1e-5f;
    EXPECT_EQ(cut(both(test::grid(1.0f, 1.0f, 10, 10), above)), 0);
}

TEST(SelfIntersection, ASphereInAnotherIsNotCutButOneBesideIsInARing) {
    TriangleMesh small = test::sphere(0.2f, 3);
    EXPECT_EQ(cut(both(test::sphere(0.3f, 3), small)), 0);
    for (Vec3f& p : small.positions)
        p.x() += 0.3f;
    EXPECT_GT(cut(both(test::sphere(0.3f, 3), small)), 20);
}

TEST(SelfIntersection, TheOrderOfTrianglesDoesNotMatter) {
    TriangleMesh mesh = test::sphere(0.2f, 2);
    for (Vec3f& p : mesh.positions)
        p.x() += 0.25f;
    mesh = both(test::sphere(0.3f, 2), mesh);
    auto forward = self_intersecting(mesh.positions, mesh.triangles);
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    auto backward = self_intersecting(mesh.positions, mesh.triangles);
    std::reverse(backward.begin(), backward.end());
    EXPECT_EQ(forward, backward);
}

TEST(SelfIntersection, BadMeshesAreRefused) {
    TriangleMesh mesh = test::grid(1.0f, 1.0f, 2, 2);
    mesh.positions[3].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW((void)self_intersecting(mesh.positions, mesh.triangles), Error);
    const TriangleMesh beyond = {{Vec3f::Zero()}, {}, {{0, 0, 1}}};
    EXPECT_THROW((void)self_intersecting(beyond.positions, beyond.triangles), Error);
}

} // namespace
} // namespace toile::geometry
