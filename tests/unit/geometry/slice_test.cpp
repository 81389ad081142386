#include "geometry/slice.h"

#include "geometry/mesh.h"
#include "geometry/nearest_surface.h"
#include "support/meshes.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::geometry {
namespace {

// Ramanujan's second approximation, good to 1e-9 here.
double ellipse_girth(double a, double b) {
    const double h = (a - b) * (a - b) / ((a + b) * (a + b));
    return std::numbers::pi * (a + b) * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
}

TEST(Slice, GirthsOfTubesMeetTheFormula) {
    for (const auto& [a, b] : {std::pair{0.3f, 0.3f}, std::pair{0.4f, 0.2f}}) {
        const TriangleMesh mesh = test::tube(a, b, 1.0f, 720, 10);
        const Plane plane{Vec3f::UnitY(), 0.437f};
        const std::vector<Loop> loops = slice(mesh.positions, mesh.triangles, plane);
        ASSERT_EQ(loops.size(), 1u);
        EXPECT_TRUE(loops[0].closed);
        const double expected = ellipse_girth(static_cast<double>(a), static_cast<double>(b));
        EXPECT_NEAR(loops[0].length(), expected, 2e-5);
        EXPECT_NEAR(hull_girth(loops[0].points, plane), expected, 2e-5);
        EXPECT_LT(loops[0].length(), expected); // an inscribed polygon
        EXPECT_TRUE(loops[0].centroid().isApprox(Vec3f(0, 0.437f, 0), 1e-4f));
    }
}

TEST(Slice, ATiltedCutThroughACylinderIsAnEllipse) {
    const TriangleMesh mesh = test::tube(0.2f, 0.2f, 2.0f, 720, 100);
    const Plane plane = Plane::through(Vec3f(0, 1, 0), Vec3f(1, 1, 0));
    const std::vector<Loop> loops = slice(mesh.positions, mesh.triangles, plane);
    ASSERT_EQ(loops.size(), 1u);
    EXPECT_NEAR(loops[0].length(), ellipse_girth(0.2 * std::numbers::sqrt2, 0.2), 1e-4);
}

TEST(Slice, VerticesInThePlaneNeitherLoseNorDoubleTheLoop) {
    const TriangleMesh mesh = test::tube(0.3f, 0.3f, 1.0f, 64, 4);
    for (const float height : {0.25f, 0.5f, 0.75f}) {
        const std::vector<Loop> loops =
            slice(mesh.positions, mesh.triangles, {Vec3f::UnitY(), height});
        ASSERT_EQ(loops.size(), 1u) << height;
        EXPECT_TRUE(loops[0].closed);
    }
    const TriangleMesh box = test::box(Vec3f::Zero(), Vec3f::Ones());
    const std::vector<Loop> flush = slice(box.positions, box.triangles, {Vec3f::UnitY(), 1.0f});
    ASSERT_EQ(flush.size(), 1u); // the lid lies in the plane: just above it, so its rim is cut
    EXPECT_NEAR(flush[0].length(), 4.0, 1e-6);
    EXPECT_TRUE(slice(box.positions, box.triangles, {Vec3f::UnitY(), 0.0f}).empty());
}

TEST(Slice, LoopsRunCounterClockwiseSeenAgainstTheNormal) {
    const TriangleMesh mesh = test::sphere(1.0f, 4);
    for (const Vec3f& axis : {Vec3f(0, 1, 0), Vec3f(1, 0, 0), Vec3f(1, 2, 3)}) {
        const Plane plane = Plane::through(Vec3f(0.1f, 0.05f, 0.0f), axis);
        const std::vector<Loop> loops = slice(mesh.positions, mesh.triangles, plane);
        ASSERT_EQ(loops.size(), 1u);
        Vec3f area = Vec3f::Zero();
        const auto& points = loops[0].points;
        for (std::size_t i = 0; i < points.size(); ++i)
            area += points[i].cross(points[(i + 1) % points.size()]);
        EXPECT_GT(area.dot(plane.normal), 1.0f);
    }
}

TEST(Slice, EveryStepRunsInTheTriangleThatIsNamed) {
    const TriangleMesh mesh = test::sphere(0.3f, 3);
    const Plane plane = Plane::through(Vec3f(0.01f, 0.05f, 0.02f), Vec3f(0.2f, 1.0f, -0.3f));
    for (const Loop& loop : slice(mesh.positions, mesh.triangles, plane)) {
        ASSERT_TRUE(loop.closed);
        ASSERT_EQ(loop.triangles.size(), loop.points.size());
        for (std::size_t i = 0; i < loop.points.size(); ++i) {
            const Vec3f middle =
                0.5f * (loop.points[i] + loop.points[(i + 1) % loop.points.size()]);
            const Triangle& t = mesh.triangles[loop.triangles[i]];
            const TriangleMesh one = {
                {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]},
                {},
                {{0, 1, 2}}};
            EXPECT_LT(NearestSurface(one.positions, one.triangles).nearest(middle).distance, 1e-6f);
        }
    }
}

TEST(Slice, SeveralPiecesGiveSeveralLoopsAndBordersOpenOnes) {
    TriangleMesh two = test::box(Vec3f::Zero(), Vec3f::Ones());
    const TriangleMesh other = test::box(Vec3f(3, 0, 0), Vec3f(4, 1, 1));
    for (const Triangle& t : other.triangles)
        two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
    EXPECT_EQ(slice(two.positions, two.triangles, {Vec3f::UnitY(), 0.5f}).size(), 2u);

    const TriangleMesh sheet = test::grid(2.0f, 1.0f, 8, 4);
    const std::vector<Loop> cut = slice(sheet.positions, sheet.triangles, {Vec3f::UnitY(), 0.6f});
    ASSERT_EQ(cut.size(), 1u);
    EXPECT_FALSE(cut[0].closed);
    EXPECT_NEAR(cut[0].length(), 2.0, 1e-6);
    EXPECT_TRUE(slice(sheet.positions, sheet.triangles, {Vec3f::UnitY(), 7.0f}).empty());
}

TEST(Girth, TheTapeSpansHollows) {
    // A square with a notch: the tape runs straight over it.
    const std::vector<Vec3f> points = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 0, 1),
                                       Vec3f(0, 0, 1), Vec3f(0.4f, 0, 0.5f)};
    EXPECT_NEAR(hull_girth(points, {Vec3f::UnitY(), 0.0f}), 4.0, 1e-6);
    const std::vector<Vec3f> line = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0.5f, 0, 0)};
    EXPECT_NEAR(hull_girth(line, {Vec3f::UnitY(), 0.0f}), 2.0, 1e-6);
    EXPECT_EQ(hull_girth({}, {Vec3f::UnitY(), 0.0f}), 0.0);
}

} // namespace
} // namespace toile::geometry
