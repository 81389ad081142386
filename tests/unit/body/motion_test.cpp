#include "body/motion.h"

#include "body/rotations.h"
#include "body/track_file.h"
#include "core/error.h"
#include "support/shared_data.h"
#include "unit/body/body_fixture.h"

#include <fstream>
#include <gtest/gtest.h>

namespace toile::body {
namespace {

using test::adult_skeleton;
using test::turn;

std::filesystem::path written(const std::string& name, const std::string& text) {
    const auto file = std::filesystem::path(testing::TempDir()) / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

std::filesystem::path avatar_file(const std::string& path) {
    return std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / path;
}

Vec3f bone(const Skeleton& skeleton, const Pose& pose, Joint joint) {
    const JointTransforms world = forward_kinematics(skeleton, pose);
    const auto j = static_cast<std::size_t>(joint);
    return (world[j + 1].translation - world[j].translation).normalized();
}

std::string refusal(const std::string& text) {
    try {
        (void)load_motion(written("bad.json", text), adult_skeleton());
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

TEST(Keyframes, TheTPoseIsTheBaseOnAnyBody) {
    const auto file = written("t.json", R"({"schema": 1, "name": "t", "keys": [{"time_s": 0}]})");
    const Skeleton skeleton = adult_skeleton();
    const Pose pose = load_pose(file, skeleton);
    for (const Joint joint : {Joint::left_upper_arm, Joint::left_lower_arm})
        EXPECT_LT((bone(skeleton, pose, joint) - Vec3f::UnitX()).norm(), 1e-5f);
    EXPECT_LT((bone(skeleton, pose, Joint::right_lower_leg) + Vec3f::UnitY()).norm(), 1e-5f);
    EXPECT_NEAR(lowest_sole(skeleton, forward_kinematics(skeleton, pose)), 0.0f, 1e-6f);
}

TEST(Keyframes, AnglesTurnAboutTheParentsAxesAndPassThroughTheKeys) {
    const auto file = written("turn.json", R"({"schema": 1, "name": "arm", "keys": [
        {"time_s": 0},
        {"time_s": 1, "rotations_deg": {"leftUpperArm": [0, 0, -90], "leftLowerArm": [0, -90, 0]}},
        {"time_s": 2}]})");
    const Skeleton skeleton = adult_skeleton();
    const Motion motion = load_motion(file, skeleton);
    EXPECT_EQ(motion.poses.size(), 121u);
    const Pose bent = sample(motion, 1.0);
    EXPECT_LT((bone(skeleton, bent, Joint::left_upper_arm) + Vec3f::UnitY()).norm(), 1e-4f);
    EXPECT_LT((bone(skeleton, bent, Joint::left_lower_arm) - Vec3f::UnitZ()).norm(), 1e-4f);
    // Monotone between keys: never beyond them.
    for (double t = 0.0; t <= 2.0; t += 0.05) {
        const Vec3f arm = bone(skeleton, sample(motion, t), Joint::left_upper_arm);
        EXPECT_GT(arm.x(), -1e-4f);
        EXPECT_LT(arm.y(), 1e-4f);
    }
    EXPECT_EQ(sample(motion, -1.0).hips_position, motion.poses.front().hips_position);
    EXPECT_EQ(sample(motion, 99.0).hips_position, motion.poses.back().hips_position);
}

TEST(Keyframes, BadFilesAreRefusedByPlace) {
    const auto keys = [](const std::string& text) {
        return refusal(R"({"schema": 1, "name": "n", "keys": [)" + text + "]}");
    };
    EXPECT_EQ(keys(R"({"time_s": 0})"), "accepted");
    EXPECT_NE(keys("").find("keys"), std::string::npos);
    EXPECT_NE(keys(R"({"time_s": 0.5})").find("first key must be at 0"), std::string::npos);
    EXPECT_NE(keys(R"({"time_s": 0}, {"time_s": 0})").find("not after"), std::string::npos);
    EXPECT_NE(keys(R"({"time_s": 0, "rotation": {}})").find("rotation"), std::string::npos);
    EXPECT_NE(keys(R"({"time_s": 0, "rotations_deg": {"LeftArm": [0, 0, 0]}})").find("LeftArm"),
              std::string::npos);
    EXPECT_NE(keys(R"({"time_s": 0, "rotations_deg": {"head": [0, 0]}})").find("head"),
              std::string::npos);
    EXPECT_NE(keys(R"({"time_s": 0, "rotations_deg": {"head": [0, 500, 0]}})").find("180"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"schema": 2, "name": "n", "keys": [{"time_s": 0}]})").find("schema"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"schema": 1, "name": "n", "base": "i", "keys": [{"time_s": 0}]})")
                  .find("t_pose"),
              std::string::npos);
    EXPECT_THROW((void)load_motion("walk.fbx", adult_skeleton()), Error);
}

TEST(Keyframes, OurMotionsStandOnTheFloorMoveSmoothlyAndKeepTheArmsOut) {
    const Skeleton skeleton = adult_skeleton();
    const test::TubeBody tube = test::tube_body(skeleton);
    const BodyVolumes volumes = measure_volumes(skeleton, tube.positions, tube.parts);
    for (const char* name : {"motions/turn.json", "motions/walk.json"}) {
        const Motion motion = load_motion(avatar_file(name), skeleton, &volumes);
        EXPECT_GT(motion.duration(), 3.0) << name;
        for (std::size_t f = 0; f < motion.poses.size(); ++f) {
            const JointTransforms world = forward_kinematics(skeleton, motion.poses[f]);
            ASSERT_NEAR(lowest_sole(skeleton, world), 0.0f, 0.01f) << name << " " << f;
            if (f == 0) continue;
            const JointTransforms last = forward_kinematics(skeleton, motion.poses[f - 1]);
            const double dt = motion.times[f] - motion.times[f - 1];
            for (std::size_t j = 0; j < kJointCount; ++j) {
                const float angle =
                    rotation_vector(world[j].rotation * last[j].rotation.conjugate()).norm();
                ASSERT_LT(angle / dt, 7.0) << name << " frame " << f << " joint " << j;
            }
        }
        // Ends as begun.
        const Pose& a = motion.poses.front();
        const Pose& b = motion.poses.back();
        EXPECT_LT((a.hips_position - b.hips_position).norm(), 0.03f) << name;
        for (std::size_t j = 0; j < 14; ++j)
            EXPECT_LT(a.rotations[j].angularDistance(b.rotations[j]), 0.03f) << name << " " << j;
    }
    for (const auto& entry : std::filesystem::directory_iterator(avatar_file("poses"))) {
        const Pose pose = load_pose(entry.path(), skeleton, &volumes);
        const JointTransforms world = forward_kinematics(skeleton, pose);
        EXPECT_NEAR(lowest_sole(skeleton, world), 0.0f, 1e-3f) << entry.path();
        for (const auto& joint : world)
            EXPECT_TRUE(joint.translation.allFinite());
    }
}

TEST(Keyframes, TheAPoseIsTheRestPose) {
    const Skeleton skeleton = adult_skeleton();
    const Pose pose = load_pose(avatar_file("poses/a_pose.json"), skeleton);
    EXPECT_LT((pose.hips_position - skeleton.rest(Joint::hips)).norm(), 1e-6f);
    for (const Quatf& q : pose.rotations)
        EXPECT_NEAR(std::abs(q.w()), 1.0f, 1e-6f);
}

TEST(Track, WhatIsWrittenReadsBackAndBytesAreFixed) {
    const Skeleton skeleton = adult_skeleton();
    Pose pose = rest_pose(skeleton);
    for (std::size_t j = 0; j < kJointCount; ++j)
        pose.rotations[j] = turn(Vec3f(1, static_cast<float>(j), 2), 3.0f * static_cast<float>(j));
    TrackedPerson person{1, TrackState::tracked, forward_kinematics(skeleton, pose), {}};
    person.confidence.fill(0.5f);
    TrackedPerson other = person;
    other.id = 2;
    other.joints[0].translation.x() += 5.0f;
    const std::array people = {person, other};
    const std::string text =
        track_line(0, 0.0, {}) + track_line(1, 0.5, people) + track_line(2, 0.75, people);
    EXPECT_EQ(text.substr(0, text.find('\n') + 1), "{\"frame\":0,\"time_s\":0,\"people\":[]}\n");
    EXPECT_NE(text.find("\"confidence\":0.5}"), std::string::npos);
    const Motion motion = load_motion(written("a.jsonl", text), skeleton);
    ASSERT_EQ(motion.poses.size(), 2u);
    EXPECT_DOUBLE_EQ(motion.times[1], 0.25);
    EXPECT_LT((motion.poses[1].hips_position - pose.hips_position).norm(), 2e-6f);
    for (std::size_t j = 0; j < kJointCount; ++j)
        EXPECT_LT(motion.poses[1].rotations[j].angularDistance(pose.rotations[j]), 2e-3f);
}

TEST(Track, BadLinesAreNamed) {
    const Skeleton skeleton = adult_skeleton();
    const auto fails = [&](const std::string& text) -> std::string {
        try {
            (void)load_motion(written("bad.jsonl", text), skeleton);
        } catch (const Error& e) {
            return e.what();
        }
        return "accepted";
    };
    TrackedPerson person{
        1, TrackState::tracked, forward_kinematics(skeleton, rest_pose(skeleton)), {}};
    const std::string good = track_line(0, 0.0, {&person, 1});
    EXPECT_NE(fails(good + "nonsense\n").find("line 2"), std::string::npos);
    EXPECT_NE(fails(good + good).find("line 2"), std::string::npos); // time does not rise
    EXPECT_EQ(fails(""), (std::filesystem::path(testing::TempDir()) / "bad.jsonl").string() +
                             ": holds no pose");
    person.joints[3].translation.x() = std::nanf("");
    EXPECT_THROW((void)track_line(0, 0.0, {&person, 1}), Error);
}

TEST(Bvh, EverySharedMotionStandsOnTheFloorWithItsBoneDirections) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "bvh_motions");
    const Skeleton skeleton = adult_skeleton();
    for (const char* name :
         {"01_01.bvh", "02_01.bvh", "131_01.bvh", "131_03.bvh", "Boxing_Toes.bvh"}) {
        const Motion motion = load_motion(folder / name, skeleton);
        std::size_t below = 0;
        float travelled = 0.0f;
        for (std::size_t f = 0; f < motion.poses.size(); ++f) {
            const JointTransforms world = forward_kinematics(skeleton, motion.poses[f]);
            for (const RigidTransform& joint : world)
                ASSERT_TRUE(joint.translation.allFinite()) << name;
            below += lowest_sole(skeleton, world) < -0.03f;
            ASSERT_GT(world[0].translation.y(), 0.1f) << name << " " << f;
            travelled = std::max(travelled, world[0].translation.norm());
        }
        EXPECT_LT(below, motion.poses.size() / 20) << name;
        EXPECT_LT(travelled, 12.0f) << name; // metres, whatever the file's unit
        const Pose& first = motion.poses.front();
        EXPECT_NEAR(first.hips_position.x(), 0.0f, 1e-4f);
        const Vec3f facing = first.rotations[0] * Vec3f::UnitZ();
        EXPECT_GT(facing.z(), 0.9f * facing.norm()) << name;
    }
}

} // namespace
} // namespace toile::body
