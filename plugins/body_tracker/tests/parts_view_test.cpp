#include "body_tracker/parts_view.h"

#include "body/usual_poses.h"
#include "body_tracker/pose_search.h"
#include "core/error.h"
#include "self_seen.h"

namespace toile::body_tracker {
namespace {

const Forest& shipped() {
    static const Forest forest = load_forest(std::filesystem::path(TOILE_SOURCE_DIR) / "plugins" /
                                             "body_tracker" / "adult.forest");
    return forest;
}

float support_of(const SelfSeen& self, PartsView& parts, const body::Pose& pose) {
    Registration registration(self.body, self.grid.camera);
    (void)registration.judge(self.seen(), pose);
    return parts.support(registration.drawing());
}

TEST(PartsView, TheTruePoseHasMoreSupportThanOneThatFacesAway) {
    const SelfSeen self(standing());
    PartsView parts(&shipped(), self.body, self.grid.camera);
    parts.look(self.seen());
    const float truth = support_of(self, parts, standing());
    EXPECT_GT(truth, 0.35f);
    EXPECT_LE(truth, 1.0f);
    EXPECT_GT(truth, support_of(self, parts, PoseSearch::turned_around(standing())) + 0.1f);
    body::Pose beside = standing();
    beside.hips_position.x() += 1.5f;
    EXPECT_LT(support_of(self, parts, beside), 0.05f);
}

TEST(PartsView, WithoutAForestEverythingAgreesAlike) {
    const SelfSeen self(standing());
    PartsView parts(nullptr, self.body, self.grid.camera);
    parts.look(self.seen());
    EXPECT_FALSE(parts.useful());
    EXPECT_EQ(support_of(self, parts, standing()), 0.0f);
}

TEST(PartsView, AForestOfOtherClassesIsRefused) {
    const TrackedBody body(adult());
    Forest other = shipped();
    other.class_count = 3;
    EXPECT_THROW(PartsView(&other, body, grid_camera()), Error);
}

/// An arm that is held out to the side was taken to hang.
TEST(PoseSearch, FindsALostArm) {
    const body::Skeleton& skeleton = adult().space().model().skeleton;
    const std::span<const body::ArmPose> ways = body::usual_arms();
    body::Pose out = body::usual_pose(skeleton, ways[2], 4.0f);
    out.hips_position = Vec3f(0.0f, -0.2f, -2.6f);
    const SelfSeen self(out);
    PartsView parts(&shipped(), self.body, self.grid.camera);
    parts.look(self.seen());
    PoseSearch search(self.body, parts, self.grid.camera);
    Registration registration(self.body, self.grid.camera);
    const body::Pose hanging = body::usual_pose(skeleton, ways[0], 4.0f);
    for (const bool left : {true, false}) {
        body::Pose pose = body::with_arm(out, left, hanging);
        ASSERT_TRUE(search.retry_arm(self.seen(), left, {}, pose, registration));
        const auto hand =
            static_cast<std::size_t>(left ? body::Joint::left_hand : body::Joint::right_hand);
        const auto at = [&](const body::Pose& p) {
            return body::forward_kinematics(skeleton, p)[hand].translation;
        };
        EXPECT_LT((at(pose) - at(out)).norm(), 0.05f);
        // And one that is right stays.
        body::Pose right = out;
        EXPECT_FALSE(search.retry_arm(self.seen(), left, {}, right, registration));
    }
}

} // namespace
} // namespace toile::body_tracker
