#include "geometry/tape.h"

#include "geometry/mesh.h"
#include "support/ellipse.h"
#include "support/meshes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace toile::geometry {
namespace {

TEST(GirthCutter, MeasuresEllipsesByTheirIntegral) {
    for (const auto& [a, b] : {std::pair{0.1, 0.1}, std::pair{0.17, 0.11}, std::pair{0.05, 0.2}}) {
        const TriangleMesh mesh =
            test::tube(static_cast<float>(a), static_cast<float>(b), 1.0f, 720, 10);
        const SurfacePart part(mesh.triangles);
        const GirthCutter cutter(mesh.positions, part, Vec3f::UnitY());
        for (const float level : {0.05f, 0.5f, 0.93f})
            EXPECT_NEAR(cutter.girth(level), test::ellipse_perimeter(a, b), 3e-5);
        EXPECT_NEAR(cutter.extent(0.3f, Vec3f::UnitX()), a, 1e-5);
        EXPECT_NEAR(cutter.extent(0.3f, -Vec3f::UnitZ()), b, 1e-5);
        EXPECT_EQ(cutter.girth(1.5f), 0.0);
    }
}

TEST(GirthCutter, AgreesWithTheHullOfTheSlice) {
    const TriangleMesh mesh = test::sphere(0.4f, 5);
    const SurfacePart part(mesh.triangles);
    const Vec3f axis = Vec3f(1, 2, -1).normalized();
    const GirthCutter cutter(mesh.positions, part, axis);
    for (float offset = -0.35f; offset < 0.36f; offset += 0.07f) {
        const Plane plane{axis, offset};
        const auto loops = slice(mesh.positions, mesh.triangles, plane);
        ASSERT_EQ(loops.size(), 1u);
        EXPECT_NEAR(cutter.girth(offset), hull_girth(loops[0].points, plane), 1e-6);
    }
}

TEST(GirthCutter, CutsOnlyItsPart) {
    TriangleMesh mesh = test::tube(0.1f, 0.1f, 1.0f, 90, 4);
    const auto own = static_cast<std::uint32_t>(mesh.positions.size());
    const std::vector<Triangle> part = mesh.triangles;
    for (const Triangle& t : part)
        mesh.triangles.push_back({t[0] + own, t[1] + own, t[2] + own});
    for (std::uint32_t v = 0; v < own; ++v)
        mesh.positions.emplace_back(mesh.positions[v] + Vec3f(0.5f, 0, 0));
    const SurfacePart first(part), both(mesh.triangles);
    const double alone = GirthCutter(mesh.positions, first, Vec3f::UnitY()).girth(0.5f);
    EXPECT_NEAR(alone, 0.2 * std::numbers::pi, 1e-3);
    EXPECT_NEAR(GirthCutter(mesh.positions, both, Vec3f::UnitY()).girth(0.5f), alone + 1.0, 1e-3);
}

TEST(TautPath, GoesRoundACylinderOnTheSideAskedFor) {
    const TriangleMesh mesh = test::tube(0.2f, 0.2f, 1.0f, 720, 10);
    const Vec3f right(-0.2f, 0.5f, 0), left(0.2f, 0.5f, 0), front(0, 0.5f, 0.2f);
    const double half = 0.2 * std::numbers::pi;
    EXPECT_NEAR(taut_path(mesh.positions, mesh.triangles, left, right, Vec3f::UnitZ()).length(),
                half, 1e-4);
    const Loop short_way =
        taut_path(mesh.positions, mesh.triangles, left, front, Vec3f(1, 0, 1).normalized());
    EXPECT_NEAR(short_way.length(), 0.5 * half, 1e-4);
    const Loop long_way =
        taut_path(mesh.positions, mesh.triangles, left, front, Vec3f(-1, 0, -1).normalized());
    EXPECT_NEAR(long_way.length(), 1.5 * half, 1e-4);
    EXPECT_EQ(short_way.points.front(), left);
    EXPECT_EQ(short_way.points.back(), front);
    for (const Vec3f& p : long_way.points)
        EXPECT_NEAR(std::hypot(p.x(), p.z()), 0.2f, 1e-4f);
}

TEST(TautPath, ReversedItIsAsLong) {
    const TriangleMesh mesh = test::sphere(0.3f, 5);
    const Vec3f a = 0.3f * Vec3f(1, 0.2f, 0.4f).normalized();
    const Vec3f b = 0.3f * Vec3f(-0.6f, 0.5f, 0.7f).normalized();
    const Vec3f side = Vec3f(0, 0.3f, 1).normalized();
    const double there = taut_path(mesh.positions, mesh.triangles, a, b, side).length();
    const double back = taut_path(mesh.positions, mesh.triangles, b, a, side).length();
    EXPECT_NEAR(there, back, 1e-6);
    EXPECT_GT(there, static_cast<double>((a - b).norm()));
}

TEST(TautPath, SpansAHollow) {
    // Two bumps side by side: the tape runs straight from crest to crest.
    TriangleMesh mesh = test::grid(1.0f, 0.4f, 200, 20);
    for (Vec3f& p : mesh.positions)
        p.z() = 0.1f * (1.0f - std::cos(4.0f * std::numbers::pi_v<float> * p.x()));
    const Vec3f from(0.0f, 0.2f, 0.0f), to(1.0f, 0.2f, 0.0f);
    const Loop tape = taut_path(mesh.positions, mesh.triangles, from, to, Vec3f::UnitZ());
    // The tangent from the end of the grid to the bump: f(x) = x f'(x), f = 0.1 (1 - cos 4 pi x).
    double x = 0.2;
    const double k = 4.0 * std::numbers::pi;
    for (int i = 0; i < 50; ++i) {
        const double f = 0.1 * (1.0 - std::cos(k * x)), g = 0.1 * k * std::sin(k * x);
        x -= (f - x * g) / (-x * 0.1 * k * k * std::cos(k * x));
    }
    double arc = 0.0; // from the point of contact to the crest at x = 1/4
    const int steps = 100000;
    for (int i = 0; i < steps; ++i) {
        const double t = x + (0.25 - x) * (i + 0.5) / steps;
        arc += (0.25 - x) / steps * std::hypot(1.0, 0.1 * k * std::sin(k * t));
    }
    const double height = 0.1 * (1.0 - std::cos(k * x));
    EXPECT_NEAR(tape.length(), 2.0 * (std::hypot(x, height) + arc) + 0.5, 2e-4);
}

TEST(TautPath, IsStraightWhereThereIsNoSurface) {
    const TriangleMesh mesh = test::sphere(0.1f, 3);
    const Vec3f a(1, 1, 1), b(2, 1, 1);
    const Loop tape = taut_path(mesh.positions, mesh.triangles, a, b, Vec3f::UnitY());
    ASSERT_EQ(tape.points.size(), 2u);
    EXPECT_NEAR(tape.length(), 1.0, 1e-6);
}

} // namespace
} // namespace toile::geometry
