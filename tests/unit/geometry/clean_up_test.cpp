// Scans mended: each fault made on purpose, found, counted and gone.
#include "geometry/clean_up.h"

#include "core/random.h"
#include "support/meshes.h"
#include "support/throws.h"

#include <cmath>
#include <gtest/gtest.h>

namespace toile::geometry {
namespace {

constexpr float kRadius = 0.5f;

CleanUpOptions unsmoothed() {
    CleanUpOptions out;
    out.smoothing = 0.0;
    return out;
}

void expect_closed(const TriangleMesh& mesh) {
    EXPECT_TRUE(check_topology(mesh.positions, mesh.triangles).closed())
        << check_topology(mesh.positions, mesh.triangles).text();
    EXPECT_GT(volume(mesh), 0.0);
}

TEST(CleanUp, ASoundSurfaceStaysAsItIs) {
    const TriangleMesh ball = test::sphere(kRadius, 3);
    const CleanMesh out = clean_up(ball, unsmoothed());
    EXPECT_EQ(out.mesh.positions, ball.positions);
    EXPECT_EQ(out.mesh.triangles.size(), ball.triangles.size());
    EXPECT_EQ(out.report.merged_points + out.report.dropped_triangles, 0u);
}

TEST(CleanUp, TrianglesWithPointsOfTheirOwnAreJoined) {
    const TriangleMesh ball = test::sphere(kRadius, 2);
    TriangleMesh soup;
    for (const Triangle& t : ball.triangles)
        for (const std::uint32_t v : t) {
            if (soup.positions.size() % 3 == 0) {
                const auto n = static_cast<std::uint32_t>(soup.positions.size());
                soup.triangles.push_back({n, n + 1, n + 2});
            }
            soup.positions.push_back(ball.positions[v]);
        }
    const CleanMesh out = clean_up(soup, unsmoothed());
    EXPECT_EQ(out.mesh.positions.size(), ball.positions.size());
    EXPECT_EQ(out.report.merged_points, soup.positions.size() - ball.positions.size());
    expect_closed(out.mesh);
}

TEST(CleanUp, AFinOnAnEdgeIsTakenAway) {
    TriangleMesh ball = test::sphere(kRadius, 3);
    const Triangle first = ball.triangles.front();
    ball.positions.push_back(2.0f * ball.positions[first[0]]);
    ball.triangles.push_back(
        {first[0], first[1], static_cast<std::uint32_t>(ball.positions.size() - 1)});
    const CleanMesh out = clean_up(ball, unsmoothed());
    EXPECT_EQ(out.report.non_manifold_edges, 1u);
    EXPECT_EQ(out.mesh.positions.size(), ball.positions.size() - 1);
    expect_closed(out.mesh);
}

TEST(CleanUp, HolesAreFilledAndFacesTurnedOutwards) {
    TriangleMesh ball = test::sphere(kRadius, 3);
    std::erase_if(ball.triangles, [&](const Triangle& t) {
        return ball.positions[t[0]].y() > 0.42f || ball.positions[t[0]].x() < -0.45f;
    });
    for (std::size_t i = 0; i < ball.triangles.size(); i += 2)
        std::swap(ball.triangles[i][0], ball.triangles[i][1]);
    const CleanMesh out = clean_up(ball, unsmoothed());
    EXPECT_EQ(out.report.filled_holes, 2u);
    expect_closed(out.mesh);
}

TEST(CleanUp, OnlyTheLargestPieceStays) {
    TriangleMesh both = test::sphere(kRadius, 3);
    const TriangleMesh crumb = test::sphere(0.05f, 1);
    const auto base = static_cast<std::uint32_t>(both.positions.size());
    for (const Vec3f& p : crumb.positions)
        both.positions.push_back(p + Vec3f(2.0f, 0.0f, 0.0f));
    for (const Triangle& t : crumb.triangles)
        both.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    const CleanMesh out = clean_up(both, unsmoothed());
    EXPECT_EQ(out.report.dropped_pieces, 1u);
    EXPECT_EQ(out.mesh.positions.size(), base);
}

TEST(CleanUp, SmoothingTakesNoiseAndHardlyShrinks) {
    const TriangleMesh ball = test::sphere(kRadius, 4);
    TriangleMesh noisy = ball;
    Random random(3);
    for (Vec3f& p : noisy.positions)
        p *= 1.0f + 0.004f * static_cast<float>(random.normal());
    const auto roughness = [](const TriangleMesh& mesh) {
        double sum = 0.0, mean = 0.0;
        for (const Vec3f& p : mesh.positions)
            mean += static_cast<double>(p.norm()) / static_cast<double>(mesh.positions.size());
        for (const Vec3f& p : mesh.positions)
            sum += std::pow(static_cast<double>(p.norm()) - mean, 2.0);
        return std::pair(std::sqrt(sum / static_cast<double>(mesh.positions.size())), mean);
    };
    TriangleMesh smooth = noisy;
    smooth.positions = smoothed(noisy, 1.0);
    EXPECT_LT(roughness(smooth).first, 0.75 * roughness(noisy).first);
    EXPECT_NEAR(roughness(smooth).second, roughness(noisy).second, 0.004);
}

TEST(CleanUp, UnusableInputIsRefusedOrLeftOut) {
    EXPECT_ERROR((void)clean_up({}), "nothing of the surface is left");
    TriangleMesh ball = test::sphere(kRadius, 3);
    ball.triangles.push_back({0, 1, 900000});
    ball.positions.emplace_back(std::nanf(""), 0.0f, 0.0f);
    ball.triangles.push_back({0, 1, static_cast<std::uint32_t>(ball.positions.size() - 1)});
    const CleanMesh out = clean_up(ball, unsmoothed());
    EXPECT_EQ(out.report.dropped_triangles, 2u);
    expect_closed(out.mesh);
}

} // namespace
} // namespace toile::geometry
