#include "body_tracker/arm_aim.h"
#include "body_tracker/pose_search.h"
#include "self_seen.h"

namespace toile::body_tracker {
namespace {

using body::Joint;

/// One arm aslant before the body with its elbow bent, as in none of the usual poses.
body::Pose arm_aslant(bool left) {
    const body::Skeleton& skeleton = adult().space().model().skeleton;
    body::ArmPose arm;
    arm.lift = 20.0f;
    arm.forward = 45.0f;
    arm.elbow = 40.0f;
    arm.turn = 30.0f;
    body::Pose pose = body::usual_pose(skeleton, body::usual_arms().front(), 4.0f);
    pose = body::with_arm(pose, left, body::usual_pose(skeleton, arm, 4.0f));
    pose.hips_position = Vec3f(0.0f, -0.2f, -2.4f);
    return pose;
}

body::Pose arm_hanging() {
    body::Pose pose =
        body::usual_pose(adult().space().model().skeleton, body::usual_arms().front(), 4.0f);
    pose.hips_position = Vec3f(0.0f, -0.2f, -2.4f);
    return pose;
}

float hand_off(const body::Pose& a, const body::Pose& b, bool left) {
    const auto hand = static_cast<std::size_t>(left ? Joint::left_hand : Joint::right_hand);
    const body::Skeleton& skeleton = adult().space().model().skeleton;
    return (body::forward_kinematics(skeleton, a)[hand].translation -
            body::forward_kinematics(skeleton, b)[hand].translation)
        .norm();
}

TEST(ArmAim, ReachesForAnArmThatIsNotExplained) {
    for (const bool left : {true, false}) {
        const SelfSeen self(arm_aslant(left));
        Registration registration(self.body, self.grid.camera);
        ArmAim aim(self.grid.camera);
        (void)registration.judge(self.seen(), arm_hanging());
        const auto poses = aim.reach(self.seen(), self.body, registration, arm_hanging(), left);
        ASSERT_FALSE(poses.empty());
        float nearest = 1e9f;
        for (const body::Pose& pose : poses)
            nearest = std::min(nearest, hand_off(pose, arm_aslant(left), left));
        EXPECT_LT(nearest, 0.12f);
    }
}

TEST(ArmAim, NothingToReachForWhereAllIsExplained) {
    const SelfSeen self(arm_aslant(true));
    Registration registration(self.body, self.grid.camera);
    ArmAim aim(self.grid.camera);
    (void)registration.judge(self.seen(), arm_aslant(true));
    EXPECT_TRUE(aim.reach(self.seen(), self.body, registration, arm_aslant(true), true).empty());
}

/// Most of these are near to no usual way of holding an arm: a third of them used to be lost.
TEST(PoseSearch, FindsArmsThatAreHeldAsNobodyUsuallyDoes) {
    const body::Skeleton& skeleton = adult().space().model().skeleton;
    int found = 0, all = 0;
    for (const float lift : {-20.0f, 10.0f, 40.0f, 70.0f})
        for (const float forward : {-30.0f, 45.0f})
            for (const float elbow : {20.0f, 120.0f})
                for (const float turn : {-60.0f, 0.0f}) {
                    const body::ArmPose arm{0.0f, lift, forward, elbow, turn};
                    const body::Pose truth =
                        body::with_arm(arm_hanging(), true, body::usual_pose(skeleton, arm, 4.0f));
                    const SelfSeen self(truth);
                    PartsView parts(shipped_forest().get(), self.body, self.grid.camera);
                    parts.look(self.seen());
                    PoseSearch search(self.body, parts, self.grid.camera);
                    Registration registration(self.body, self.grid.camera);
                    body::Pose pose = arm_hanging();
                    (void)search.retry_arm(self.seen(), true, {}, pose, registration);
                    for (int step = 0; step < 4; ++step)
                        (void)registration.step(self.seen(), {}, nullptr, pose);
                    ++all;
                    found += hand_off(pose, truth, true) < 0.05f ? 1 : 0;
                }
    EXPECT_GE(100 * found, 75 * all) << found << " of " << all;
}

/// Who walks away from the camera is taken to face away, if both explain as much.
TEST(PoseSearch, ExpectsPeopleToWalkAhead) {
    const SelfSeen self(arm_hanging());
    PartsView parts(nullptr, self.body, self.grid.camera);
    PoseSearch search(self.body, parts, self.grid.camera);
    Registration registration(self.body, self.grid.camera);
    const float standing = search.rate(self.seen(), arm_hanging(), registration);
    search.expect(Vec3f(0.0f, 0.0f, 1.0f)); // towards the camera, as the person faces
    EXPECT_EQ(search.rate(self.seen(), arm_hanging(), registration), standing);
    search.expect(Vec3f(0.0f, 0.0f, -0.1f)); // stands
    EXPECT_EQ(search.rate(self.seen(), arm_hanging(), registration), standing);
    search.expect(Vec3f(0.0f, 0.0f, -1.0f));
    EXPECT_GT(search.rate(self.seen(), arm_hanging(), registration), standing + 0.05f);
}

} // namespace
} // namespace toile::body_tracker
