#include "body_tracker/depth_grid.h"
#include "body_tracker/pose_smoother.h"

#include <gtest/gtest.h>
#include <limits>

namespace toile::body_tracker {
namespace {

imaging::Intrinsics vga() {
    return {640, 480, 580.0, 580.0, 319.5, 239.5, {}};
}

TEST(DepthGrid, ACellTakesTheSurfaceThatFillsMostOfIt) {
    const DepthReducer reducer(vga());
    DepthGrid grid = reducer.blank();
    ASSERT_EQ(grid.camera.width, 160);
    ASSERT_EQ(grid.camera.height, 120);
    std::vector<float> metres(640 * 480, 3.0f);
    const auto block = [&](int column, int row, int pixels, float depth) {
        for (int i = 0; i < pixels; ++i)
            metres[static_cast<std::size_t>((4 * row + i / 4) * 640 + 4 * column + i % 4)] = depth;
    };
    block(10, 10, 10, 2.0f);
    block(11, 10, 6, 2.0f);
    block(12, 10, 14, std::numeric_limits<float>::quiet_NaN());
    block(13, 10, 16, 0.0f);
    block(14, 10, 8, 3.02f);
    reducer.reduce(metres.data(), grid);
    const auto at = [&](int column) {
        return grid.depth[static_cast<std::size_t>(10 * 160 + column)];
    };
    EXPECT_FLOAT_EQ(at(10), 2.0f);
    EXPECT_FLOAT_EQ(at(11), 3.0f);
    EXPECT_EQ(at(12), 0.0f);
    EXPECT_EQ(at(13), 0.0f);
    EXPECT_NEAR(at(14), 3.01f, 1e-5f);
}

TEST(DepthGrid, ACellsRayGoesThroughTheMiddleOfItsBlock) {
    const DepthReducer reducer(vga());
    const GridCamera& grid = reducer.grid();
    for (const auto& [x, y] : {std::pair{0, 0}, {79, 30}, {159, 119}}) {
        const Vec3f point = grid.point(static_cast<float>(x), static_cast<float>(y), 2.0f);
        const auto pixel = imaging::project(vga(), point.cast<double>());
        ASSERT_TRUE(pixel.has_value());
        EXPECT_NEAR(pixel->x(), 4 * x + 1.5, 1e-3);
        EXPECT_NEAR(pixel->y(), 4 * y + 1.5, 1e-3);
        const Vec2f back = grid.cell(point);
        EXPECT_NEAR(back.x(), static_cast<float>(x), 1e-4f);
        EXPECT_NEAR(back.y(), static_cast<float>(y), 1e-4f);
    }
}

TEST(DepthGrid, DistortionIsUndone) {
    imaging::Intrinsics bent = vga();
    bent.distortion[0] = 0.1;
    const DepthReducer reducer(bent);
    // Depths that tell their column: the cell's depth is that of where the lens bent its ray to.
    std::vector<float> metres(640 * 480);
    for (std::size_t i = 0; i < metres.size(); ++i)
        metres[i] = 2.0f + 0.0001f * static_cast<float>(i % 640);
    DepthGrid grid = reducer.blank();
    reducer.reduce(metres.data(), grid);
    const Vec3f ray = grid.camera.point(10.0f, 20.0f, 1.0f);
    const auto pixel = imaging::project(bent, ray.cast<double>());
    EXPECT_NEAR(grid.depth[20 * 160 + 10], 2.0f + 0.0001f * static_cast<float>(pixel->x()), 1e-4f);
}

/// A hand on a straight arm (0.6 m) that moves at 2 m/s may lag by 20 ms; at rest noise shrinks.
TEST(PoseSmoother, FastMotionHardlyLagsAndRestHardlyShakes) {
    PoseSmoother smoother({});
    constexpr float kStep = 1.0f / 30.0f, kSpeed = 2.0f / 0.6f; // rad/s
    body::Pose pose;
    Quatf shown = Quatf::Identity();
    for (int f = 0; f < 30; ++f) {
        pose.rotations[7] = body::about(Vec3f::UnitZ(), kSpeed * kStep * static_cast<float>(f));
        shown = smoother.update(pose, kStep).rotations[7];
    }
    EXPECT_LT(shown.angularDistance(pose.rotations[7]) / kSpeed, 0.020f);

    smoother.reset();
    double in = 0.0, out = 0.0;
    for (int f = 0; f < 300; ++f) {
        body::Pose noisy;
        const float noise = 0.01f * std::sin(12.9f * static_cast<float>(f * f));
        noisy.hips_position.x() = noise;
        const float smooth = smoother.update(noisy, kStep).hips_position.x();
        in += static_cast<double>(noise * noise);
        out += static_cast<double>(smooth * smooth);
    }
    EXPECT_LT(out, 0.5 * in);
}

TEST(PoseSmoother, SwitchedOffItChangesNothing) {
    SmoothingOptions off;
    off.on = false;
    PoseSmoother smoother(off);
    for (int f = 0; f < 5; ++f) {
        body::Pose pose;
        pose.hips_position.x() = static_cast<float>(f * f);
        EXPECT_EQ(smoother.update(pose, 0.033f).hips_position, pose.hips_position);
    }
}

} // namespace
} // namespace toile::body_tracker
