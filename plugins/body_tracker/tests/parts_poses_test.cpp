#include "body_tracker/parts_poses.h"

#include "body/body_space.h"
#include "body/joint_limits.h"
#include "core/error.h"
#include "support/shared_data.h"

#include <cmath>
#include <gtest/gtest.h>

namespace toile::body_tracker {
namespace {

const body::Skeleton& skeleton() {
    static const body::BodyModel model = body::load_body_model(body::find_avatar("woman"));
    return model.skeleton;
}

double yaw(const body::Pose& pose) {
    const Vec3f ahead = pose.rotations[0] * Vec3f::UnitZ();
    return std::atan2(static_cast<double>(ahead.x()), static_cast<double>(ahead.z()));
}

TEST(PartsPoses, PerturbedByNothingIsTheSamePose) {
    Random random(1);
    const body::Pose pose = standing_pose(skeleton(), random);
    const body::Pose same = perturbed(pose, 0.0, random);
    for (std::size_t j = 0; j < body::kJointCount; ++j)
        EXPECT_LT(same.rotations[j].angularDistance(pose.rotations[j]), 1e-3f);
}

TEST(PartsPoses, StandingPeopleFaceAheadAndHoldTheirHandsEverywhere) {
    Random random(2);
    int above_head = 0, before_chest = 0, beside_hips = 0;
    for (int k = 0; k < 400; ++k) {
        const body::Pose pose = standing_pose(skeleton(), random);
        EXPECT_LT(std::abs(yaw(pose)), 0.4);
        const auto world = body::forward_kinematics(skeleton(), pose);
        const auto at = [&](body::Joint joint) {
            return world[static_cast<std::size_t>(joint)].translation;
        };
        const Vec3f hand = at(body::Joint::left_hand);
        above_head += hand.y() > at(body::Joint::head).y() + 0.1f ? 1 : 0;
        before_chest += hand.z() > at(body::Joint::chest).z() + 0.3f ? 1 : 0;
        beside_hips += std::abs(hand.y() - at(body::Joint::hips).y()) < 0.15f ? 1 : 0;
        EXPECT_GT(at(body::Joint::head).y(), at(body::Joint::hips).y() + 0.4f);
    }
    EXPECT_GT(above_head, 20);
    EXPECT_GT(before_chest, 30);
    EXPECT_GT(beside_hips, 40);
}

TEST(PartsPoses, OnlyRecordedOnesWhenTheMixSaysSo) {
    Random random(3);
    std::vector<body::Pose> recorded = {standing_pose(skeleton(), random)};
    for (int k = 0; k < 20; ++k) {
        const body::Pose pose = draw_pose(skeleton(), recorded, {1.0, 0.0, 0.0}, random);
        const body::Pose other = body::mirrored(recorded[0]);
        const auto distance = [&](const body::Pose& to) {
            return pose.rotations[7].angularDistance(to.rotations[7]);
        };
        EXPECT_LT(std::min(distance(recorded[0]), distance(other)), 1e-3f);
    }
}

TEST(PartsPoses, MotionsThatAreNotThereAreNamed) {
    const std::vector<std::filesystem::path> none = {"/no/such/motion.bvh"};
    EXPECT_THROW((void)read_poses(none, skeleton()), Error);
}

TEST(PartsPoses, RecordedMotionsFaceAhead) {
    TOILE_SHARED_DATA_OR_SKIP(motions, "bvh_motions");
    const std::vector<std::filesystem::path> files = {motions / "131_03.bvh"};
    const auto poses = read_poses(files, skeleton());
    EXPECT_NEAR(static_cast<double>(poses.size()), 92.0, 3.0); // 9.2 s
    for (const body::Pose& pose : poses)
        EXPECT_LT(std::abs(yaw(pose)), 1e-3);
}

} // namespace
} // namespace toile::body_tracker
