#include "self_seen.h"

namespace toile::body_tracker {
namespace {

/// Correctives and shared skin are left out of the derivative: places of one bone only.
TEST(Registration, MotionOfAPlaceAgreesWithDifferences) {
    TrackedBody body(adult());
    const body::Pose pose = standing();
    PosedBody posed = body.blank(), moved = body.blank();
    body.pose(pose, posed);
    Random random(3);
    int tested = 0;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(body.level().triangles.size()); t += 7) {
        const Triangle& corners = body.level().triangles[static_cast<std::size_t>(t)];
        bool one_bone = true;
        for (const std::uint32_t v : corners) {
            one_bone = one_bone && body.level().skin.weights[v][0] > 0.999f;
            one_bone =
                one_bone && body.level().correctives.weights[v].cwiseAbs().maxCoeff() < 1e-4f;
        }
        if (!one_bone) continue;
        ++tested;
        const std::array<float, 3> weights{0.2f, 0.5f, 0.3f};
        const auto place = [&](const PosedBody& where) {
            Vec3f out = Vec3f::Zero();
            for (std::size_t k = 0; k < 3; ++k)
                out += weights[k] * where.positions[corners[k]];
            return out;
        };
        Vec3f along(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                    static_cast<float>(random.normal()));
        along.normalize();
        PlaceMotion motion;
        body.motion(posed, t, weights, place(posed), along, motion);
        Eigen::VectorXd row = Eigen::VectorXd::Zero(body::kPoseUnknowns);
        for (std::size_t b = 0; b < static_cast<std::size_t>(motion.count); ++b)
            row.segment<3>(motion.start[b]) = motion.block[b].cast<double>();
        for (int u = 0; u < body::kPoseUnknowns; ++u) {
            constexpr double kStep = 2e-3;
            Eigen::VectorXd step = Eigen::VectorXd::Zero(body::kPoseUnknowns);
            step[u] = kStep;
            body.pose(body::moved_pose(pose, step.data()), moved);
            const double ahead = static_cast<double>(along.dot(place(moved)));
            step[u] = -kStep;
            body.pose(body::moved_pose(pose, step.data()), moved);
            const double behind = static_cast<double>(along.dot(place(moved)));
            ASSERT_NEAR(row[u], (ahead - behind) / (2.0 * kStep), 2e-3)
                << "triangle " << t << ", unknown " << u;
        }
    }
    EXPECT_GT(tested, 10);
}

TEST(Registration, ABodyAgreesWithItself) {
    const SelfSeen self(standing());
    Registration registration(self.body, self.grid.camera);
    const Agreement agreement = registration.judge(self.seen(), standing());
    EXPECT_LT(agreement.error_m, 1e-6f);
    EXPECT_EQ(agreement.unexplained, 0.0f);
}

TEST(Registration, StepsLeadBackToWhereTheBodyIs) {
    const SelfSeen self(standing());
    Registration registration(self.body, self.grid.camera);
    body::Pose pose = standing();
    pose.hips_position += Vec3f(0.05f, 0.03f, -0.06f);
    pose.rotations[static_cast<std::size_t>(body::Joint::left_upper_arm)] =
        body::about(Vec3f::UnitZ(), 0.3f) *
        pose.rotations[static_cast<std::size_t>(body::Joint::left_upper_arm)];
    const Agreement before = registration.judge(self.seen(), pose);
    for (int step = 0; step < 12; ++step)
        registration.step(self.seen(), {}, nullptr, pose);
    const Agreement after = registration.judge(self.seen(), pose);
    EXPECT_LT(after.badness(), 0.3f * before.badness());
    EXPECT_LT(after.error_m, 0.006f);
    EXPECT_LT((pose.hips_position - standing().hips_position).norm(), 0.02f);
}

/// P5's limits: what is 6 cm off or not explained to 15 % is a failure, and must look like one.
TEST(Registration, AWrongPoseIsNotExplained) {
    const SelfSeen self(standing());
    Registration registration(self.body, self.grid.camera);
    body::Pose pose = standing();
    pose.rotations[static_cast<std::size_t>(body::Joint::left_upper_leg)] =
        body::about(Vec3f::UnitX(), -1.2f);
    EXPECT_GT(registration.judge(self.seen(), pose).unexplained, 0.15f);
}

TEST(PersonMask, NearestCellsAreTheNearest) {
    const GridCamera camera{40, 30, 40.0f, 40.0f, 20.0f, 15.0f};
    PersonMask mask(camera);
    Random random(4);
    for (int i = 0; i < 12; ++i)
        mask.cells[random.next() % camera.size()] = 1;
    find_nearest(camera, mask);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            int best = 1 << 20;
            for (std::size_t i = 0; i < mask.cells.size(); ++i) {
                const int dx = static_cast<int>(i) % camera.width - x;
                const int dy = static_cast<int>(i) / camera.width - y;
                if (mask.cells[i] != 0) best = std::min(best, dx * dx + dy * dy);
            }
            const int found = mask.nearest[static_cast<std::size_t>(y * camera.width + x)];
            ASSERT_GE(found, 0);
            const int dx = found % camera.width - x, dy = found / camera.width - y;
            EXPECT_LE(std::sqrt(dx * dx + dy * dy), std::sqrt(best) + 0.5) << x << ", " << y;
        }
}

} // namespace
} // namespace toile::body_tracker
