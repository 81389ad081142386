// Which readings of the depth camera hide cloth.
#include "apps/kiosk/hiding_depth.h"

#include <gtest/gtest.h>

namespace toile::test {
namespace {

using namespace apps::kiosk;

constexpr int kSide = 64;
constexpr float kTrunk_m = 1.0f, kLift_m = 0.08f;
constexpr int kReach = 3;

/// A flat trunk a metre before the camera, and one point of a tracked hand over its middle.
struct HandBeforeTrunk {
    std::vector<Vec3f> positions, normals;
    std::vector<body::Part> parts;
    imaging::Intrinsics camera;
    imaging::DepthImage seen{kSide, kSide, std::vector<float>(kSide* kSide, kTrunk_m)};

    explicit HandBeforeTrunk(float tracked_m) {
        camera.width = camera.height = kSide;
        camera.fx = camera.fy = 200.0;
        camera.cx = camera.cy = 0.5 * kSide;
        for (int y = -16; y <= 16; ++y)
            for (int x = -16; x <= 16; ++x)
                add({0.01f * float(x), 0.01f * float(y), -kTrunk_m}, body::Part::torso);
        add({0.0f, 0.0f, -tracked_m}, body::Part::left_lower_arm);
    }

    void add(const Vec3f& at, body::Part part) {
        positions.push_back(at);
        normals.emplace_back(0.0f, 0.0f, 1.0f);
        parts.push_back(part);
    }

    /// Pixels that hide cloth which the readings alone would not hide.
    [[nodiscard]] std::vector<std::size_t> lifted() const {
        const TrackedSkin skin{positions, normals, parts};
        const Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
        TrunkDepth trunk;
        trunk.fill(skin, camera, place, kSide, kSide);
        imaging::DepthImage out = seen;
        lift_bare_parts(skin, {static_cast<std::uint32_t>(positions.size() - 1)}, camera, place,
                        seen, trunk, kLift_m, kReach, out);
        std::vector<std::size_t> pixels;
        for (std::size_t i = 0; i < out.metres.size(); ++i) {
            if (out.metres[i] == seen.metres[i]) continue;
            EXPECT_FLOAT_EQ(out.metres[i], seen.metres[i] - kLift_m);
            pixels.push_back(i);
        }
        return pixels;
    }
};

TEST(KioskHidingDepth, AHandThatTheTrackerSeesAndTheCameraDoesNotTearsNoHole) {
    const HandBeforeTrunk scene(kTrunk_m - 0.015f);
    EXPECT_TRUE(scene.lifted().empty());
}

TEST(KioskHidingDepth, AHandThatBothSeeIsLiftedAndTheTrunkBesideItIsNot) {
    HandBeforeTrunk scene(kTrunk_m - 0.05f);
    const int middle = kSide / 2;
    for (int y = middle - 1; y <= middle + 1; ++y)
        for (int x = middle - 1; x <= middle + 1; ++x)
            scene.seen.metres[static_cast<std::size_t>(y * kSide + x)] = kTrunk_m - 0.05f;
    const auto pixels = scene.lifted();
    EXPECT_EQ(pixels.size(), 9u);
    for (const std::size_t i : pixels)
        EXPECT_FLOAT_EQ(scene.seen.metres[i], kTrunk_m - 0.05f);
}

TEST(KioskHidingDepth, OutsideTheTrunkNothingHoldsAHandBack) {
    TrunkDepth trunk;
    const HandBeforeTrunk scene(kTrunk_m);
    const TrackedSkin nobody;
    trunk.fill(nobody, scene.camera, Eigen::Isometry3d::Identity(), kSide, kSide);
    EXPECT_FALSE(trunk.reaches(0, 0, 5.0f));
    EXPECT_FALSE(trunk.reaches(kSide - 1, kSide - 1, 5.0f));
}

} // namespace
} // namespace toile::test
