#include "imaging/camera.h"

#include "core/random.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <limits>

namespace toile::imaging {
namespace {

Intrinsics kinect() {
    return {640, 480, 570.0, 572.0, 319.5, 241.25, {}};
}

Intrinsics wide() {
    Intrinsics camera = kinect();
    camera.distortion = {-0.28, 0.09, 0.0008, -0.0004, -0.01, 0.002, 0.001, -0.0005};
    return camera;
}

TEST(Camera, LooksAlongMinusZWithRowsGoingDown) {
    const Intrinsics camera = kinect();
    EXPECT_TRUE(project(camera, Vec3d(0, 0, -2))->isApprox(Eigen::Vector2d(319.5, 241.25)));
    EXPECT_LT(project(camera, Vec3d(0, 0.5, -2))->y(), 241.25); // higher: a smaller row
    EXPECT_GT(project(camera, Vec3d(0.5, 0, -2))->x(), 319.5);
    EXPECT_FALSE(project(camera, Vec3d(0, 0, 2)).has_value());
    EXPECT_FALSE(project(camera, Vec3d(0, 0, 0)).has_value());
    const auto corner = unproject(camera, {0, 0}, 1.0);
    EXPECT_LT(corner->x(), 0.0);
    EXPECT_GT(corner->y(), 0.0);
    EXPECT_EQ(corner->z(), -1.0);
    EXPECT_NEAR(camera.field_of_view().x(), 2.0 * std::atan(320.0 / 570.0), 1e-12);
}

TEST(Camera, PixelsComeBackThroughTheDistortion) {
    for (const Intrinsics& camera : {kinect(), wide()}) {
        Random random(1);
        for (int i = 0; i < 500; ++i) {
            const Eigen::Vector2d pixel(random.uniform(0, 639), random.uniform(0, 479));
            const double depth = random.uniform(0.4, 5.0);
            const auto point = unproject(camera, pixel, depth);
            ASSERT_TRUE(point.has_value());
            EXPECT_NEAR(-point->z(), depth, 1e-12);
            EXPECT_LT((*project(camera, *point) - pixel).norm(), 1e-6);
        }
    }
}

TEST(Camera, KnownDistortion) {
    Intrinsics camera = kinect();
    camera.distortion[0] = 0.1;  // k1
    camera.distortion[2] = 0.01; // p1
    // x = 0.5, y = 0.25 (down), r2 = 0.3125: x' = x (1 + 0.03125) + 2 p1 x y
    const double x = 0.5 * 1.03125 + 2.0 * 0.01 * 0.125;
    const double y = 0.25 * 1.03125 + 0.01 * (0.3125 + 2.0 * 0.0625);
    const auto pixel = project(camera, Vec3d(1.0, -0.5, -2.0));
    EXPECT_NEAR(pixel->x(), 570.0 * x + 319.5, 1e-9);
    EXPECT_NEAR(pixel->y(), 572.0 * y + 241.25, 1e-9);
}

TEST(Camera, DistortionThatFoldsOverIsSaid) {
    Intrinsics camera = kinect();
    camera.distortion[0] = -5.0;
    EXPECT_FALSE(unproject(camera, {0, 0}, 1.0).has_value());
    EXPECT_TRUE(unproject(camera, {319.5, 241.25}, 1.0).has_value());
}

TEST(DepthUnprojector, KeepsUnknownUnknown) {
    const Intrinsics camera = wide();
    const DepthUnprojector unprojector(camera);
    std::vector<float> depth(640 * 480, std::numeric_limits<float>::quiet_NaN());
    depth[100 * 640 + 37] = 2.5f;
    std::vector<Vec3f> points(depth.size());
    unprojector.points(depth, points);
    EXPECT_FALSE(points[0].allFinite());
    const auto expected = unproject(camera, {37, 100}, 2.5);
    EXPECT_TRUE(points[100 * 640 + 37].isApprox(expected->cast<float>(), 1e-5f));
}

TEST(RegisterColor, EachDepthPixelGetsTheColourOfItsPlace) {
    const Intrinsics depth_camera{40, 30, 40.0, 40.0, 19.5, 14.5, {}};
    const Intrinsics color_camera{80, 60, 80.0, 80.0, 39.5, 29.5, {}};
    DepthImage depth{40, 30, std::vector<float>(40 * 30, 2.0f)};
    depth.metres[5] = std::numeric_limits<float>::quiet_NaN();
    Image color{80, 60, {}};
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 80; ++x)
            for (const int v : {3 * x, 4 * y, 50, 255})
                color.pixels.push_back(static_cast<std::uint8_t>(v));
    Eigen::Isometry3d shifted = Eigen::Isometry3d::Identity();
    shifted.translation().x() = 0.1; // the colour camera stands 10 cm to the left: 4 pixels at 2 m
    const Image result = register_color(depth, depth_camera, color, color_camera, shifted);
    const std::size_t i = 10 * 40 + 12;
    const auto place = unproject(depth_camera, {12, 10}, 2.0);
    const auto pixel = project(color_camera, shifted * *place);
    EXPECT_NEAR(pixel->x(), 2.0 * (12 - 19.5) + 39.5 + 4.0, 1e-9);
    EXPECT_NEAR(result.pixels[4 * i], 3.0 * pixel->x(), 1.0);
    EXPECT_NEAR(result.pixels[4 * i + 1], 4.0 * pixel->y(), 1.0);
    EXPECT_EQ(result.pixels[4 * i + 3], 255);
    EXPECT_EQ(result.pixels[4 * 5 + 3], 0);              // unknown depth
    EXPECT_EQ(result.pixels[4 * (10 * 40 + 39) + 3], 0); // out of sight
}

TEST(Camera, BadIntrinsicsAreRefused) {
    Intrinsics camera = kinect();
    camera.fx = 0.0;
    EXPECT_ERROR(check_intrinsics(camera), "focal");
    camera = kinect();
    camera.cy = NAN;
    EXPECT_ERROR(check_intrinsics(camera), "not finite");
    camera = kinect();
    camera.width = 0;
    EXPECT_ERROR(DepthUnprojector{camera}, "makes no sense");
}

} // namespace
} // namespace toile::imaging
