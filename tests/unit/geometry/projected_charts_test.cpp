// Charts of any surface: none on another, every triangle with area, no vertex lost.
#include "geometry/projected_charts.h"

#include "geometry/flat_cover.h"
#include "geometry/packing.h"
#include "support/meshes.h"
#include "support/throws.h"

#include <gtest/gtest.h>

namespace toile::geometry {
namespace {

/// Area in the texture, counter-clockwise as one looks at it (v runs downwards).
double flat_area(const SeamedLayout& layout, const Triangle& t) {
    const Vec2f a = layout.texcoords[t[1]] - layout.texcoords[t[0]],
                b = layout.texcoords[t[2]] - layout.texcoords[t[0]];
    return -0.5 * static_cast<double>(a.x() * b.y() - a.y() * b.x());
}

void expect_sound(const TriangleMesh& mesh, const ProjectedAtlas& atlas) {
    ASSERT_EQ(atlas.layout.triangles.size(), mesh.triangles.size());
    FlatCover cover(0.02);
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = atlas.layout.triangles[f];
        std::array<Vec3f, 3> p;
        FlatCover::Corners corners;
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(atlas.layout.welded[t[k]], mesh.triangles[f][k]);
            p[k] = mesh.positions[mesh.triangles[f][k]];
            const Vec2f& uv = atlas.layout.texcoords[t[k]];
            ASSERT_TRUE((uv.array() > 0.0f).all() && (uv.array() < 1.0f).all());
            corners[k] = Eigen::Vector2d(static_cast<double>(uv.x()), -static_cast<double>(uv.y()));
        }
        const double area = 0.5 * static_cast<double>((p[1] - p[0]).cross(p[2] - p[0]).norm());
        const double scale = static_cast<double>(atlas.side) * static_cast<double>(atlas.side);
        const double share = flat_area(atlas.layout, t) * scale / area;
        EXPECT_GT(share, 0.24) << f;
        EXPECT_LT(share, 1.01) << f;
        // Corners were rounded to floats: drawn in by a little they must not overlap.
        const Eigen::Vector2d middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for (Eigen::Vector2d& c : corners)
            c = middle + 0.999 * (c - middle);
        EXPECT_TRUE(cover.add(corners)) << "triangle " << f << " lies on another";
    }
}

TEST(ProjectedCharts, ABallHasOneForEachSide) {
    const TriangleMesh ball = test::sphere(0.5f, 4);
    const ProjectedAtlas atlas = make_projected_atlas(ball.positions, ball.triangles);
    EXPECT_EQ(atlas.chart_count, 6);
    expect_sound(ball, atlas);
}

/// A ribbon that winds up like a spring without an end to its turns: seen along its axis the turns
/// lie on each other.
TriangleMesh spring(int turns) {
    constexpr int kSteps = 24;
    TriangleMesh out;
    for (int i = 0; i <= turns * kSteps; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / kSteps;
        const float height = 0.1f * static_cast<float>(i) / kSteps;
        for (const float radius : {0.3f, 0.5f})
            out.positions.emplace_back(radius * std::sin(angle), height, radius * std::cos(angle));
    }
    for (std::uint32_t i = 0; i + 3 < out.positions.size(); i += 2) {
        out.triangles.push_back({i, i + 1, i + 2});
        out.triangles.push_back({i + 1, i + 3, i + 2});
    }
    return out;
}

TEST(ProjectedCharts, WhatWouldLieOnItselfIsCut) {
    const TriangleMesh ribbon = spring(3);
    const ProjectedAtlas atlas = make_projected_atlas(ribbon.positions, ribbon.triangles);
    EXPECT_GE(atlas.chart_count, 3);
    EXPECT_LE(atlas.chart_count, 4);
    expect_sound(ribbon, atlas);
}

TEST(ProjectedCharts, ChartsKeepTheirGap) {
    const TriangleMesh ball = test::sphere(0.5f, 4);
    const AtlasOptions options{512, 6};
    const ProjectedAtlas atlas = make_projected_atlas(ball.positions, ball.triangles, options);
    std::vector<Eigen::AlignedBox2f> boxes(static_cast<std::size_t>(atlas.chart_count));
    for (std::size_t f = 0; f < ball.triangles.size(); ++f)
        for (const std::uint32_t v : atlas.layout.triangles[f])
            boxes[static_cast<std::size_t>(atlas.charts[f])].extend(512.0f *
                                                                    atlas.layout.texcoords[v]);
    const Eigen::AlignedBox2f inside(Vec2f::Constant(5.99f), Vec2f::Constant(506.01f));
    for (std::size_t a = 0; a < boxes.size(); ++a) {
        EXPECT_TRUE(inside.contains(boxes[a]));
        for (std::size_t b = 0; b < a; ++b)
            EXPECT_GE(boxes[a].exteriorDistance(boxes[b]), 5.99f) << a << " " << b;
    }
}

TEST(ProjectedCharts, NothingToPaintIsRefused) {
    EXPECT_ERROR((void)make_projected_atlas({}, {}), "without area");
    const std::vector<Vec2f> many(1000, Vec2f::Constant(0.001f));
    EXPECT_ERROR((void)pack_boxes(many, 0.1f), "do not fit into one texture");
}

TEST(FlatCover, NeighboursTouchAndOthersDoNotOverlap) {
    using P = Eigen::Vector2d;
    FlatCover cover(0.5);
    EXPECT_TRUE(cover.add({P(0, 0), P(1, 0), P(0, 1)}));
    EXPECT_TRUE(cover.add({P(1, 0), P(1, 1), P(0, 1)}));    // shares a side
    EXPECT_TRUE(cover.add({P(0, 0), P(-1, 0), P(-1, -1)})); // shares a corner
    EXPECT_FALSE(cover.add({P(0.2, 0.2), P(0.3, 0.2), P(0.2, 0.3)}));
    EXPECT_FALSE(cover.add({P(-3, 0.4), P(3, 0.4), P(0, 0.5)}));
    EXPECT_TRUE(cover.add({P(2, 2), P(3, 2), P(2, 3)}));
}

} // namespace
} // namespace toile::geometry
