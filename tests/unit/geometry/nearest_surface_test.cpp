#include "geometry/nearest_surface.h"

#include "core/random.h"
#include "geometry/closest_point.h"
#include "geometry/mesh.h"
#include "support/meshes.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <thread>

namespace toile::geometry {
namespace {

Vec3f random_point(Random& random, double size) {
    return {static_cast<float>(random.uniform(-size, size)),
            static_cast<float>(random.uniform(-size, size)),
            static_cast<float>(random.uniform(-size, size))};
}

TEST(ClosestPoint, NothingOnTheTriangleIsNearer) {
    Random random(5);
    for (int round = 0; round < 300; ++round) {
        const Vec3f a = random_point(random, 1);
        const Vec3f b = random_point(random, 1);
        const Vec3f c = random_point(random, 1);
        const Vec3f p = random_point(random, 2);
        const ClosestPoint found = closest_point(p, a, b, c);
        EXPECT_NEAR(found.barycentric.sum(), 1.0f, 1e-5f);
        EXPECT_GE(found.barycentric.minCoeff(), -1e-6f);
        const Vec3f again =
            found.barycentric[0] * a + found.barycentric[1] * b + found.barycentric[2] * c;
        EXPECT_LT((again - found.point).norm(), 1e-5f);
        for (int i = 0; i <= 20; ++i)
            for (int k = 0; i + k <= 20; ++k) {
                const float u = static_cast<float>(i) / 20.0f;
                const float v = static_cast<float>(k) / 20.0f;
                const Vec3f other = (1.0f - u - v) * a + u * b + v * c;
                EXPECT_GE((other - p).norm(), (found.point - p).norm() - 1e-5f);
            }
    }
}

TEST(ClosestPoint, TrianglesWithoutArea) {
    const Vec3f p(0.5f, 1.0f, 0.0f);
    const ClosestPoint line =
        closest_point(p, Vec3f::Zero(), Vec3f::UnitX(), Vec3f(0.25f, 0.0f, 0.0f));
    EXPECT_TRUE(line.point.isApprox(Vec3f(0.5f, 0, 0)));
    const ClosestPoint spot = closest_point(p, Vec3f::Ones(), Vec3f::Ones(), Vec3f::Ones());
    EXPECT_TRUE(spot.point.isApprox(Vec3f::Ones()));
}

SurfacePoint by_force(const TriangleMesh& mesh, const Vec3f& p) {
    SurfacePoint best;
    float best_squared = std::numeric_limits<float>::infinity();
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const ClosestPoint found =
            closest_point(p, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
        const float squared = (found.point - p).squaredNorm();
        if (squared >= best_squared) continue;
        best_squared = squared;
        best.triangle = i;
        best.point = found.point;
        best.distance = std::sqrt(squared);
    }
    return best;
}

void compare_with_force(const TriangleMesh& mesh, const NearestSurface& surface) {
    Random random(21);
    for (int i = 0; i < 500; ++i) {
        const Vec3f p = i % 5 == 0 ? mesh.positions[random.next() % mesh.positions.size()]
                                   : random_point(random, 1.5);
        const SurfacePoint expected = by_force(mesh, p);
        const SurfacePoint found = surface.nearest(p);
        EXPECT_EQ(found.triangle, expected.triangle); // also among equals: the lowest
        EXPECT_EQ(found.point, expected.point);
        EXPECT_EQ(found.distance, expected.distance);
    }
}

TEST(NearestSurface, AgreesWithBruteForceAlsoAfterARefit) {
    TriangleMesh mesh = test::sphere(1.0f, 3);
    NearestSurface surface(mesh.positions, mesh.triangles);
    compare_with_force(mesh, surface);
    Random random(8);
    for (Vec3f& p : mesh.positions)
        p = Vec3f(0.6f * p.x(), 1.3f * p.y(), p.z() + 0.2f) + 0.02f * random_point(random, 1.0);
    surface.refit(mesh.positions);
    compare_with_force(mesh, surface);
}

TEST(NearestSurface, SignsOfABoxAlsoAtItsEdgesAndCorners) {
    const TriangleMesh mesh = test::box(Vec3f(-1, -1, -1), Vec3f::Ones());
    const NearestSurface surface(mesh.positions, mesh.triangles);
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const Vec3f p = random_point(random, 2.0);
        const Vec3f q = p.cwiseAbs() - Vec3f::Ones();
        const float expected =
            q.cwiseMax(0.0f).norm() + std::min(q.maxCoeff(), 0.0f); // distance to a box
        const SurfacePoint found = surface.nearest(p);
        EXPECT_NEAR(found.signed_distance, expected, 2e-6f) << p.transpose();
        EXPECT_EQ(found.distance, std::abs(found.signed_distance));
    }
    const SurfacePoint corner = surface.nearest(Vec3f(2, 2, 2));
    EXPECT_TRUE(corner.normal.isApprox(Vec3f::Ones().normalized(), 1e-5f));
}

TEST(NearestSurface, ARadiusBoundsTheSearch) {
    const TriangleMesh mesh = test::sphere(1.0f, 3);
    const NearestSurface surface(mesh.positions, mesh.triangles);
    EXPECT_EQ(surface.nearest(Vec3f(3, 0, 0), 1.9f).triangle, kNoTriangle);
    EXPECT_NE(surface.nearest(Vec3f(3, 0, 0), 2.1f).triangle, kNoTriangle);
    EXPECT_EQ(surface.nearest(Vec3f(NAN, 0, 0)).triangle, kNoTriangle);
}

TEST(NearestSurface, ManyThreadsGetTheSameAnswers) {
    const TriangleMesh mesh = test::sphere(1.0f, 4);
    const NearestSurface surface(mesh.positions, mesh.triangles);
    std::vector<Vec3f> points;
    Random random(4);
    for (int i = 0; i < 2000; ++i)
        points.push_back(random_point(random, 1.5));
    std::vector<std::vector<SurfacePoint>> results(4, std::vector<SurfacePoint>(points.size()));
    std::vector<std::thread> threads;
    for (auto& result : results)
        threads.emplace_back([&] { surface.nearest(points, result); });
    for (std::thread& thread : threads)
        thread.join();
    for (const auto& result : results)
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(result[i].triangle, results[0][i].triangle);
            EXPECT_EQ(result[i].signed_distance, results[0][i].signed_distance);
        }
}

TEST(Rays, HitTheNearSideFirst) {
    const TriangleMesh mesh = test::sphere(1.0f, 5);
    const NearestSurface surface(mesh.positions, mesh.triangles);
    const auto hit = surface.first_hit(Vec3f(0.013f, 0.017f, 3), Vec3f(0, 0, -1));
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance, 2.0f, 1e-3f);
    const Triangle& t = mesh.triangles[hit->triangle];
    const Vec3f point = hit->barycentric[0] * mesh.positions[t[0]] +
                        hit->barycentric[1] * mesh.positions[t[1]] +
                        hit->barycentric[2] * mesh.positions[t[2]];
    EXPECT_TRUE(point.isApprox(Vec3f(0.013f, 0.017f, 3.0f - hit->distance), 1e-5f));
    const auto far_side = surface.first_hit(Vec3f(0.013f, 0.017f, 3), Vec3f(0, 0, -1), 2.5f);
    ASSERT_TRUE(far_side.has_value());
    EXPECT_NEAR(far_side->distance, 4.0f, 1e-3f);
    EXPECT_FALSE(surface.first_hit(Vec3f(0, 2, 3), Vec3f(0, 0, -1)).has_value());
    EXPECT_FALSE(surface.blocked(Vec3f(0, 0, 3), Vec3f(0, 0, -1), 0.0f, 1.9f));
    EXPECT_TRUE(surface.blocked(Vec3f(0, 0, 3), Vec3f(0, 0, -1), 0.0f, 2.1f));
}

TEST(NearestSurface, BadSurfacesAreRefused) {
    TriangleMesh mesh = test::box(Vec3f::Zero(), Vec3f::Ones());
    EXPECT_ERROR(NearestSurface(mesh.positions, {}), "no triangles");
    NearestSurface surface(mesh.positions, mesh.triangles);
    EXPECT_ERROR(surface.refit(std::span(mesh.positions).first(3)), "cannot be refitted");
    mesh.triangles[1][2] = 8;
    EXPECT_ERROR(NearestSurface(mesh.positions, mesh.triangles), "out of range");
    mesh.triangles[1][2] = 1;
    mesh.positions[0].x() = NAN;
    EXPECT_ERROR(NearestSurface(mesh.positions, mesh.triangles), "not finite");
}

} // namespace
} // namespace toile::geometry
