#include "pipeline/body_frame.h"

#include <gtest/gtest.h>

namespace toile::pipeline {
namespace {

using body::Joint;

body::Skeleton ladder() {
    body::Skeleton skeleton;
    for (std::size_t i = 0; i < body::kJointCount; ++i)
        skeleton.rest_positions[i] =
            Vec3f(0.1f * static_cast<float>(i % 5), 0.05f * static_cast<float>(i), 0.02f);
    return skeleton;
}

body::Pose bent() {
    body::Pose pose;
    pose.hips_position = Vec3f(0.3f, 1.0f, -0.2f);
    for (std::size_t i = 0; i < body::kJointCount; ++i)
        pose.rotations[i] = Quatf(Eigen::AngleAxisf(
            0.1f * static_cast<float>(i), Vec3f(1.0f, static_cast<float>(i), 2.0f).normalized()));
    return pose;
}

TEST(BodyFrame, LocalPoseUndoesForwardKinematics) {
    const auto skeleton = ladder();
    const body::Pose pose = bent();
    const body::Pose back = local_pose(body::forward_kinematics(skeleton, pose));
    EXPECT_LT((back.hips_position - pose.hips_position).norm(), 1e-6f);
    for (std::size_t i = 0; i < body::kJointCount; ++i)
        EXPECT_LT(back.rotations[i].angularDistance(pose.rotations[i]), 1e-3f) << i;
}

TEST(BodyFrame, JointsSurviveTheBoundaryStruct) {
    const auto world = body::forward_kinematics(ladder(), bent());
    const auto back = transforms_of(joints_of(world, 0.5f));
    for (std::size_t i = 0; i < body::kJointCount; ++i) {
        EXPECT_EQ(back[i].translation, world[i].translation);
        EXPECT_EQ(back[i].rotation.coeffs(), world[i].rotation.coeffs());
    }
}

TEST(BodyFrame, BonesKeepTheirLengthBetweenTwoPoses) {
    const auto skeleton = ladder();
    const auto world =
        body::forward_kinematics(skeleton, interpolate(body::rest_pose(skeleton), bent(), 0.4f));
    for (std::size_t i = 1; i < body::kJointCount; ++i) {
        const auto parent = static_cast<std::size_t>(*body::joint_parent(static_cast<Joint>(i)));
        const float now = (world[i].translation - world[parent].translation).norm();
        EXPECT_NEAR(now, skeleton.offset(static_cast<Joint>(i)).norm(), 1e-5f) << i;
    }
}

TEST(BodyFrame, RestJointsAreTheRestPositionsUnturned) {
    const auto skeleton = ladder();
    const auto joints = transforms_of(rest_joints(skeleton));
    for (std::size_t i = 0; i < body::kJointCount; ++i) {
        EXPECT_LT((joints[i].translation - skeleton.rest_positions[i]).norm(), 1e-6f);
        EXPECT_LT(joints[i].rotation.angularDistance(Quatf::Identity()), 1e-6f);
    }
}

} // namespace
} // namespace toile::pipeline
