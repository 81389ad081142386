#include "scan/ball.h"

#include "core/random.h"
#include "support/depth_pictures.h"

#include <gtest/gtest.h>

namespace toile::scan {
namespace {

using test::depth_picture;

imaging::Intrinsics kinect() {
    imaging::Intrinsics out;
    out.width = 320;
    out.height = 240;
    out.fx = out.fy = 290.0;
    out.cx = 159.5;
    out.cy = 119.5;
    return out;
}

/// A ball on a stick before a wall, and something square that is larger.
std::vector<float> scene(const Vec3f& centre, float radius, float noise_m, std::uint64_t seed = 1) {
    geometry::TriangleMesh mesh = test::sphere(radius, 6);
    for (Vec3f& p : mesh.positions)
        p += centre;
    const auto add = [&](const geometry::TriangleMesh& other) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
        for (const Triangle& t : other.triangles)
            mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    };
    const Vec3f under = centre - Vec3f(0, 0.9f * radius, 0);
    add(test::box(under - Vec3f(0.006f, 0.5f, 0.006f), under + Vec3f(0.006f, 0, 0.006f)));
    add(test::box({-3, -3, -3.2f}, {3, 3, -3.1f}));
    add(test::box({-0.6f, -0.6f, -1.9f}, {-0.3f, -0.25f, -1.6f}));
    const geometry::NearestSurface surface(mesh.positions, mesh.triangles);
    return depth_picture(surface, kinect(), Eigen::Isometry3d::Identity(), noise_m, seed);
}

TEST(Ball, IsFoundOnItsStickAndItsRadiusToo) {
    const Vec3f centre(0.2f, 0.1f, -1.5f);
    const auto found = find_ball(kinect(), scene(centre, 0.1f, 0.0f), {});
    ASSERT_TRUE(found);
    EXPECT_LT((found->ball.centre - centre.cast<double>()).norm(), 0.0005);
    EXPECT_NEAR(found->ball.radius_m, 0.1, 0.0005);
}

TEST(Ball, NoiseAveragesOut) {
    BallOptions known;
    known.radius_m = 0.1;
    double square = 0.0;
    constexpr int kTries = 12;
    for (int k = 0; k < kTries; ++k) {
        const Vec3f centre(-0.1f + 0.03f * static_cast<float>(k), 0.15f, -1.6f);
        const auto found = find_ball(
            kinect(), scene(centre, 0.1f, 0.01f, static_cast<std::uint64_t>(k) + 1), known);
        ASSERT_TRUE(found) << k;
        square += (found->ball.centre - centre.cast<double>()).squaredNorm() / kTries;
        EXPECT_DOUBLE_EQ(found->ball.radius_m, 0.1);
    }
    EXPECT_LT(std::sqrt(square), 0.0015); // of single readings 5.8 mm
}

TEST(Ball, OutliersCountForLittle) {
    const Vec3d centre(0.1, -0.05, -1.2);
    Random random(5);
    std::vector<Vec3f> points;
    for (int k = 0; k < 800; ++k) {
        Vec3d out(random.normal(), random.normal(), random.normal());
        out.normalize();
        if (out.dot(-centre) < 0.0) out = -out; // towards the camera
        Vec3d p = centre + 0.12 * out;
        if (k % 8 == 0) p *= 1.02; // 2.4 cm too far
        points.push_back(p.cast<float>());
    }
    Ball start;
    start.centre = centre + Vec3d(0.01, 0.02, -0.01);
    start.radius_m = 0.11;
    const auto ball = fit_ball(points, start, false);
    ASSERT_TRUE(ball);
    EXPECT_LT((ball->centre - centre).norm(), 0.004);
    EXPECT_NEAR(ball->radius_m, 0.12, 0.004);
}

TEST(Ball, WhatIsNotRoundIsNone) {
    const auto none = find_ball(kinect(), scene({0, 5, -1.5f}, 0.1f, 0.0f), {}); // out of sight
    EXPECT_FALSE(none);
    const std::vector<float> nothing(320 * 240, std::nanf(""));
    EXPECT_FALSE(find_ball(kinect(), nothing, {}));
    BallOptions other;
    other.radius_m = 0.2;
    EXPECT_FALSE(find_ball(kinect(), scene({0.2f, 0.1f, -1.5f}, 0.1f, 0.0f), other));
}

} // namespace
} // namespace toile::scan
