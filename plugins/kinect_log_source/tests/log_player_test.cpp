#include "kinect_log_source/log_player.h"

#include "support/shared_data.h"
#include "unit/body/body_fixture.h"

#include <gtest/gtest.h>
#include <set>

namespace toile::kinect_log_source {
namespace {

using body::Joint;
using body::kJointCount;

std::size_t index(Joint joint) {
    return static_cast<std::size_t>(joint);
}

/// Somebody 2.5 m from the sensor, in its frame (x to their right), both arms hanging.
LoggedFrame standing_frame(std::int64_t time) {
    LoggedFrame frame;
    frame.time_100ns = time;
    const auto set = [&](std::size_t joint, float x, float y) {
        frame.joints[joint] = {Vec3f(x, y, 2.5f), 2};
    };
    set(0, 0, -0.3f);
    set(1, 0, 0.0f);
    set(2, 0, 0.3f);
    set(3, 0, 0.45f);
    set(20, 0, 0.23f);
    for (const float side : {-1.0f, 1.0f}) { // the person's left is at negative x
        const std::size_t arm = side < 0 ? 4 : 8;
        const std::size_t leg = side < 0 ? 12 : 16;
        const std::size_t tip = side < 0 ? 21 : 23;
        set(arm, 0.18f * side, 0.2f);
        set(arm + 1, 0.24f * side, -0.05f);
        set(arm + 2, 0.26f * side, -0.28f);
        set(arm + 3, 0.26f * side, -0.35f);
        set(tip, 0.26f * side, -0.43f);
        set(tip + 1, 0.24f * side, -0.36f);
        set(leg, 0.08f * side, -0.32f);
        set(leg + 1, 0.09f * side, -0.7f);
        set(leg + 2, 0.1f * side, -1.07f);
        set(leg + 3, 0.11f * side, -1.12f);
        frame.joints[leg + 3].position.z() = 2.4f;
    }
    return frame;
}

KinectLog standing_log(std::size_t frames) {
    KinectLog log;
    log.joint_count = 25;
    for (std::size_t i = 0; i < frames; ++i)
        log.frames.push_back(standing_frame(static_cast<std::int64_t>(i) * 333333));
    return log;
}

struct Played {
    std::vector<PlayedFrame> frames;
    float arm_depth = 0.0f;
};

Played play(const KinectLog& log) {
    const body::Skeleton skeleton = test::adult_skeleton();
    const test::TubeBody tube = test::tube_body(skeleton);
    LogPlayer player(log, skeleton, body::measure_volumes(skeleton, tube.positions, tube.parts));
    Played played;
    while (player.advance()) {
        played.frames.push_back(player.frame());
        played.arm_depth = std::max(played.arm_depth, player.arm_depth());
    }
    return played;
}

Vec3f position(const PlayedFrame& frame, Joint joint) {
    return frame.joints[index(joint)].translation;
}

float knee_bend_forward(const PlayedFrame& frame, Joint hip) {
    const Vec3f& a = frame.joints[index(hip)].translation;
    const Vec3f& knee = frame.joints[index(hip) + 1].translation;
    const Vec3f& ankle = frame.joints[index(hip) + 2].translation;
    const Vec3f ahead = frame.joints[0].rotation * Vec3f::UnitZ();
    return body::across(knee - a, (ankle - a).normalized()).dot(ahead);
}

TEST(LogPlayer, APersonStandsAtTheOriginUprightAndFacesTheSensor) {
    const Played played = play(standing_log(30));
    const PlayedFrame& frame = played.frames.back();
    const Vec3f hips = position(frame, Joint::hips);
    EXPECT_NEAR(hips.x(), 0.0f, 0.02f);
    EXPECT_NEAR(hips.z(), 0.0f, 0.06f);
    EXPECT_NEAR(hips.y(), test::adult_skeleton().rest(Joint::hips).y(), 0.02f);
    EXPECT_GT((frame.joints[0].rotation * Vec3f::UnitZ()).z(), 0.99f);
    EXPECT_GT(position(frame, Joint::left_hand).x(), 0.1f); // faces +Z: its left is at +X
    EXPECT_LT(position(frame, Joint::right_hand).x(), -0.1f);
    EXPECT_EQ(frame.tracking, PlayedFrame::Tracking::tracked);
    for (const Joint foot : {Joint::left_foot, Joint::right_foot})
        EXPECT_NEAR(position(frame, foot).y(), 0.085f, 0.005f);
    for (const float c : frame.confidence)
        EXPECT_FLOAT_EQ(c, 1.0f);
}

TEST(LogPlayer, LeftStaysLeft) {
    KinectLog log = standing_log(40);
    for (LoggedFrame& frame : log.frames) { // the left arm (negative x) is held out sideways
        frame.joints[5].position = Vec3f(-0.44f, 0.2f, 2.5f);
        frame.joints[6].position = Vec3f(-0.68f, 0.2f, 2.5f);
        frame.joints[7].position = Vec3f(-0.75f, 0.2f, 2.5f);
        frame.joints[21].position = Vec3f(-0.82f, 0.2f, 2.5f);
    }
    const PlayedFrame frame = play(log).frames.back();
    EXPECT_GT(position(frame, Joint::left_hand).x(), 0.55f);
    EXPECT_NEAR(position(frame, Joint::left_hand).y(), position(frame, Joint::left_upper_arm).y(),
                0.03f);
    EXPECT_LT(position(frame, Joint::right_hand).y(), 1.0f);
}

TEST(LogPlayer, AnArmLoggedThroughTheBodyIsEasedOut) {
    KinectLog log = standing_log(40);
    for (LoggedFrame& frame : log.frames) { // the left hand in the middle of the belly
        frame.joints[5].position = Vec3f(-0.2f, -0.05f, 2.52f);
        frame.joints[6].position = Vec3f(0.0f, 0.0f, 2.5f);
        frame.joints[7].position = Vec3f(0.05f, 0.0f, 2.5f);
        frame.joints[21].position = Vec3f(0.1f, 0.0f, 2.5f);
    }
    const Played played = play(log);
    EXPECT_LT(played.arm_depth, 0.003f);
    EXPECT_GT(position(played.frames.back(), Joint::left_hand).z(),
              position(played.frames.back(), Joint::chest).z() + 0.1f);
}

TEST(LogPlayer, JointsThatAreNotTrackedRelaxAndLoseConfidence) {
    KinectLog log = standing_log(90);
    for (std::size_t i = 0; i < log.frames.size(); ++i) {
        for (const std::size_t joint : {5u, 6u, 7u, 21u, 22u}) {
            log.frames[i].joints[joint].position = Vec3f(9, 9, 9); // nonsense
            log.frames[i].joints[joint].state = 0;
        }
    }
    const PlayedFrame frame = play(log).frames.back();
    EXPECT_LT(frame.confidence[index(Joint::left_hand)], 0.01f);
    EXPECT_LT(position(frame, Joint::left_hand).y(), 1.0f); // hangs
    EXPECT_GT(position(frame, Joint::left_hand).x(), 0.1f);
}

TEST(LogPlayer, EverySharedLogGivesSoundPosesTwiceTheSame) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "kinect2_laban_gestures");
    const body::Skeleton skeleton = test::adult_skeleton();
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".csv") continue;
        const std::string name = entry.path().filename();
        const KinectLog log = load_kinect_log(entry.path());
        const Played played = play(log);
        const Played again = play(log);
        ASSERT_EQ(played.frames.size(), log.frames.size());
        EXPECT_LT(played.arm_depth, 0.002f) << name;
        for (std::size_t f = 0; f < played.frames.size(); ++f) {
            const PlayedFrame& frame = played.frames[f];
            ASSERT_EQ(frame.sequence, f);
            for (std::size_t i = 0; i < kJointCount; ++i) {
                const RigidTransform& joint = frame.joints[i];
                ASSERT_TRUE(joint.translation.allFinite() && joint.rotation.coeffs().allFinite());
                ASSERT_EQ(joint.translation, again.frames[f].joints[i].translation) << name;
                ASSERT_EQ(joint.rotation.coeffs(), again.frames[f].joints[i].rotation.coeffs());
                ASSERT_NEAR(joint.rotation.norm(), 1.0f, 1e-4f);
                ASSERT_LT(frame.angular_velocity[i].norm(), 20.0f) << name << " " << f << " " << i;
                if (i == 0) continue;
                const auto parent =
                    static_cast<std::size_t>(*body::joint_parent(static_cast<Joint>(i)));
                ASSERT_NEAR((joint.translation - frame.joints[parent].translation).norm(),
                            skeleton.offset(static_cast<Joint>(i)).norm(), 2e-6f)
                    << name << " " << f;
            }
            for (const Joint hip : {Joint::left_upper_leg, Joint::right_upper_leg})
                ASSERT_GT(knee_bend_forward(frame, hip), -1e-3f) << name << " " << f;
            for (const Joint foot : {Joint::left_foot, Joint::right_foot}) {
                ASSERT_GT(position(frame, foot).y(), 0.084f) << name << " " << f;
                ASSERT_LT(position(frame, foot).y(), 0.2f) << name << " " << f;
            }
        }
    }
}

} // namespace
} // namespace toile::kinect_log_source
