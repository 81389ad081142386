#include "garment/block_triangulate.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::garment::block {
namespace {

std::vector<Vec2d> disc(const std::size_t count, const double radius) {
    std::vector<Vec2d> out;
    for (std::size_t i = 0; i < count; ++i) {
        const double a =
            2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
        out.emplace_back(radius * std::cos(a), radius * std::sin(a));
    }
    return out;
}

double area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

TEST(Pattern, ResamplesAtEqualDistances) {
    const std::vector<Vec2d> line = {{0.0, 0.0}, {3.0, 0.0}, {3.0, 1.0}};
    const auto points = resample(line, 4);
    ASSERT_EQ(points.size(), 5u);
    EXPECT_NEAR((points[3] - Vec2d(3.0, 0.0)).norm(), 0.0, 1e-12);
    EXPECT_EQ(points.back(), line.back());
    EXPECT_NEAR(length(arc(2.0, 1.5, 0.8)), 1.2, 1e-3);
}

TEST(Triangulate, FillsADiscOnceWithGoodTriangles) {
    const auto outline = disc(60, 0.2);
    const FlatMesh mesh = triangulate(outline, 0.02);
    ASSERT_EQ(mesh.border_count, outline.size());
    double sum = 0.0;
    double worst = 1.0; // of 4 sqrt(3) area / sum of squared edges: 1 for an equilateral triangle
    for (const Triangle& t : mesh.triangles) {
        const Vec2d& a = mesh.points[t[0]];
        const Vec2d& b = mesh.points[t[1]];
        const Vec2d& c = mesh.points[t[2]];
        ASSERT_GT(area(a, b, c), 0.0);
        sum += area(a, b, c);
        worst = std::min(
            worst, 4.0 * std::sqrt(3.0) * area(a, b, c) /
                       ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm()));
    }
    double polygon = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        polygon += area(Vec2d::Zero(), outline[i], outline[(i + 1) % outline.size()]);
    }
    EXPECT_NEAR(sum, polygon, 1e-9);
    EXPECT_GT(worst, 0.5);
}

TEST(Triangulate, HarmonicReproducesLinearFields) {
    const FlatMesh mesh = triangulate(disc(40, 0.2), 0.03);
    const auto field = [](const Vec2d& p) {
        return Vec3d(1.0 + 2.0 * p.x(), p.y() - p.x(), 3.0 * p.y());
    };
    std::vector<Vec3d> border;
    for (std::size_t i = 0; i < mesh.border_count; ++i) {
        border.push_back(field(mesh.points[i]));
    }
    const auto values = harmonic(mesh, border);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        EXPECT_NEAR((values[i] - field(mesh.points[i])).norm(), 0.0, 1e-10);
    }
}

} // namespace
} // namespace toile::garment::block
