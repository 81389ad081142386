// What room two surfaces leave, and where a part of the body ends.
#include "cloth/body_places.h"

#include <gtest/gtest.h>

namespace toile::cloth {
namespace {

/// A plane through a point that stands still.
SkinPlane plane_through(const Vec4& point, const Vec4& normal) {
    const Vec4 unit = normal.normalized();
    return {{unit.x(), unit.y(), unit.z(), unit.dot(point)}, Vec4::Zero()};
}

float height(const SkinPlane& plane, const Vec4& p) {
    return direction(plane.normal).dot(p) - plane.normal.w();
}

constexpr float kOffset = 0.004f;
const Vec4 kAt(0, 1, 0, 0);

TEST(ShareRoom, PlanesWithRoomBetweenStayAsTheyAre) {
    SkinPlane own = plane_through(kAt, {0, 0, 1, 0});
    SkinPlane other = plane_through({0, 1, 0.02f, 0}, {0, 0, -1, 0});
    const SkinPlane own_before = own;
    const SkinPlane other_before = other;
    EXPECT_FALSE(share_room(own, other, kAt, kOffset));
    EXPECT_EQ(own.normal, own_before.normal);
    EXPECT_EQ(other.normal, other_before.normal);
}

TEST(ShareRoom, SurfacesThatRunIntoEachOtherMeetInTheMiddle) {
    for (const float overlap : {-0.004f, 0.0f, 0.006f, 0.015f}) {
        SkinPlane own = plane_through(kAt, {0, 0, 1, 0});
        SkinPlane other = plane_through({0, 1, -overlap, 0}, {0, 0, -1, 0});
        EXPECT_TRUE(share_room(own, other, kAt, kOffset));
        const Vec4 middle(0, 1, -0.5f * overlap, 0);
        EXPECT_NEAR(height(own, middle), kOffset, 1e-6f) << overlap;
        EXPECT_NEAR(height(other, middle), kOffset, 1e-6f) << overlap;
    }
}

TEST(ShareRoom, TheyMoveWithTheMeanOfBothSkins) {
    SkinPlane own = plane_through(kAt, {0, 0, 1, 0});
    SkinPlane other = plane_through({0, 1, -0.01f, 0}, {0, 0, -1, 0});
    own.velocity = {0.3f, 0, 0.2f, 0.2f};
    other.velocity = {0, 0, -0.6f, 0.6f};
    EXPECT_TRUE(share_room(own, other, kAt, kOffset));
    EXPECT_NEAR(own.velocity.w(), -0.2f, 1e-6f);
    EXPECT_NEAR(other.velocity.w(), 0.2f, 1e-6f);
}

// Else each push would carry cloth a little further out of the cleft, and none back.
TEST(ShareRoom, PlanesThatLeanDoNotPressClothOutOfTheCleft) {
    SkinPlane own = plane_through(kAt, {0, -0.3f, 1, 0});
    SkinPlane other = plane_through({0, 1, -0.01f, 0}, {0, -0.5f, -1, 0});
    EXPECT_TRUE(share_room(own, other, kAt, kOffset));
    EXPECT_NEAR(direction(own.normal).dot(direction(other.normal)), -1.0f, 1e-6f);
}

TEST(ShareRoom, BesideTheFarSideOfALimbTheOwnPlaneStays) {
    SkinPlane own = plane_through(kAt, {0, 0, 1, 0});
    SkinPlane other = plane_through({0, 1, -0.08f, 0}, {0, 0, -1, 0});
    EXPECT_TRUE(share_room(own, other, kAt, kOffset));
    EXPECT_NEAR(height(own, kAt), 0.0f, 1e-6f);
    EXPECT_GE(height(other, {0, 1, kOffset, 0}), kOffset - 1e-6f);
}

TEST(ShareRoom, AWedgeThatLeavesRoomFurtherOutIsKept) {
    SkinPlane own = plane_through(kAt, {0, 0, 1, 0});
    SkinPlane other = plane_through({0.05f, 1, 0.0f, 0}, {1, 0, 0.001f, 0}); // leans its way
    const SkinPlane other_before = other;
    EXPECT_FALSE(share_room(own, other, kAt, kOffset));
    EXPECT_EQ(other.normal, other_before.normal);
}

/// A strip of squares along x, 1 cm each; the right half moves with joint 1.
struct Strip {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    std::vector<std::array<std::uint16_t, 4>> joints;
    std::vector<std::array<float, 4>> weights;

    Strip() {
        for (std::uint32_t i = 0; i <= 10; ++i) {
            for (const float z : {0.0f, -0.01f}) {
                positions.emplace_back(0.01f * float(i), 0.0f, z);
                joints.push_back({std::uint16_t(i <= 5 ? 0 : 1), 0, 0, 0});
                weights.push_back({1.0f, 0.0f, 0.0f, 0.0f});
            }
        }
        for (std::uint32_t a = 0; a < 20; a += 2) {
            triangles.push_back({a, a + 2, a + 1});
            triangles.push_back({a + 1, a + 2, a + 3});
        }
    }
};

TEST(OnRim, APartEndsWhereTheNextOneIsNotAllowed) {
    const Strip strip;
    const MovingBody body({strip.positions, strip.triangles, strip.joints, strip.weights});
    constexpr JointMask kLeft = 1u;
    const SurfacePoint beyond = body.walk(Vec4(0.09f, 0.01f, -0.005f, 0), 0, kLeft);
    EXPECT_TRUE(on_rim(body, beyond, kLeft));
    const SurfacePoint over = body.walk(Vec4(0.025f, 0.01f, -0.005f, 0), 0, kLeft);
    EXPECT_FALSE(on_rim(body, over, kLeft));
    // The surface's own border is no rim: there is nothing beyond it.
    const SurfacePoint beside = body.walk(Vec4(0.025f, 0.0f, 0.01f, 0), 0, kLeft);
    EXPECT_FALSE(on_rim(body, beside, kLeft));
}

} // namespace
} // namespace toile::cloth
