#include "body/skeleton.h"

#include "abi/body.h"
#include "unit/body/body_fixture.h"

#include <gtest/gtest.h>

namespace toile::body {
namespace {

using test::adult_skeleton;
using test::turn;

TEST(Skeleton, NamesAndIndicesAreThoseOfTheBoundary) {
    ASSERT_EQ(kJointCount, static_cast<std::size_t>(TOILE_JOINT_COUNT));
    EXPECT_EQ(static_cast<int>(Joint::right_hand), TOILE_JOINT_RIGHT_HAND);
    EXPECT_EQ(static_cast<int>(Joint::right_toes), TOILE_JOINT_RIGHT_TOES);
    EXPECT_EQ(joint_name(Joint::left_upper_arm), "leftUpperArm");
    for (std::size_t i = 0; i < kJointCount; ++i) {
        const auto joint = static_cast<Joint>(i);
        EXPECT_EQ(joint_from_name(joint_name(joint)), joint);
        const auto parent = joint_parent(joint);
        EXPECT_EQ(parent.has_value(), i != 0);
        if (parent) {
            EXPECT_LT(*parent, joint);
        }
    }
    EXPECT_FALSE(joint_from_name("LeftUpperArm"));
    EXPECT_EQ(joint_parent(Joint::left_shoulder), Joint::upper_chest);
    EXPECT_EQ(joint_parent(Joint::right_upper_leg), Joint::hips);
}

TEST(Skeleton, RestPoseGivesTheRestPositionsAndIdentityTransforms) {
    const Skeleton skeleton = adult_skeleton();
    const JointTransforms world = forward_kinematics(skeleton, rest_pose(skeleton));
    const JointTransforms skinning = skinning_transforms(skeleton, world);
    for (std::size_t i = 0; i < kJointCount; ++i) {
        EXPECT_LT((world[i].translation - skeleton.rest_positions[i]).norm(), 1e-6f);
        EXPECT_LT(skinning[i].translation.norm(), 1e-6f);
        EXPECT_NEAR(std::abs(skinning[i].rotation.w()), 1.0f, 1e-6f);
    }
}

TEST(Skeleton, BoneLengthsHoldInAnyPose) {
    const Skeleton skeleton = adult_skeleton();
    Pose pose = rest_pose(skeleton);
    for (std::size_t i = 0; i < kJointCount; ++i) {
        const auto k = static_cast<float>(i);
        pose.rotations[i] = turn(Vec3f(1.0f + k, 2.0f - k, 0.5f * k), 17.0f * k);
    }
    const JointTransforms world = forward_kinematics(skeleton, pose);
    for (std::size_t i = 1; i < kJointCount; ++i) {
        const auto parent = static_cast<std::size_t>(*joint_parent(static_cast<Joint>(i)));
        const float length = (world[i].translation - world[parent].translation).norm();
        EXPECT_NEAR(length, skeleton.offset(static_cast<Joint>(i)).norm(), 1e-6f);
    }
}

TEST(Skeleton, AnElbowBentForwardMovesTheHandForward) {
    const Skeleton skeleton = adult_skeleton();
    Pose pose = rest_pose(skeleton);
    // Left lower arm points to +X and down; a turn about -Y takes +X towards +Z.
    pose.rotations[static_cast<std::size_t>(Joint::left_lower_arm)] = turn(-Vec3f::UnitY(), 90.0f);
    const JointTransforms world = forward_kinematics(skeleton, pose);
    const Vec3f& hand = world[static_cast<std::size_t>(Joint::left_hand)].translation;
    const Vec3f& elbow = world[static_cast<std::size_t>(Joint::left_lower_arm)].translation;
    EXPECT_LT((elbow - skeleton.rest(Joint::left_lower_arm)).norm(), 1e-6f);
    EXPECT_GT(hand.z(), elbow.z() + 0.15f);
}

} // namespace
} // namespace toile::body
