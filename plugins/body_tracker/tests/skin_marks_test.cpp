#include "body_tracker/skin_marks.h"

#include "body/rotations.h"
#include "self_seen.h"

#include <numeric>

namespace toile::body_tracker {
namespace {

/// Four pixels a cell.
imaging::Intrinsics camera() {
    const GridCamera grid = grid_camera();
    imaging::Intrinsics out{
        4 * grid.width, 4 * grid.height, 4.0 * grid.fx, 4.0 * grid.fy, 0.0, 0.0, {}};
    out.cx = 4.0 * grid.cx + 1.5;
    out.cy = 4.0 * grid.cy + 1.5;
    return out;
}

/// Patches of some centimetres, fixed to the skin.
float print_of(const Vec3f& p) {
    return 0.5f + 0.2f * std::sin(150.0f * p.x() + 3.0f * std::sin(90.0f * p.y())) +
           0.2f * std::sin(140.0f * p.y() + 2.0f * std::sin(110.0f * p.z())) +
           0.1f * std::sin(160.0f * p.z());
}

/// A body in a printed suit; `light`: factor of the brightness.
std::vector<std::uint8_t> painted(const TrackedBody& body, const body::Pose& pose, float light) {
    const imaging::Intrinsics in = camera();
    const GridCamera pixels{in.width,
                            in.height,
                            static_cast<float>(in.fx),
                            static_cast<float>(in.fy),
                            static_cast<float>(in.cx),
                            static_cast<float>(in.cy)};
    PosedBody posed = body.blank();
    Drawing drawing = body.blank_drawing(pixels);
    body.pose(pose, posed);
    body.draw(posed, pixels, drawing);
    std::vector<std::uint8_t> out(4 * pixels.size(), 60);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const DrawnCell& cell = drawing.cells[i];
        if (cell.depth == 0.0f) continue;
        const Triangle& t = body.level().triangles[static_cast<std::size_t>(cell.triangle)];
        const Vec3f at = (1.0f - cell.b1 - cell.b2) * body.level().mean[t[0]] +
                         cell.b1 * body.level().mean[t[1]] + cell.b2 * body.level().mean[t[2]];
        const auto tone = static_cast<std::uint8_t>(200.0f * light * print_of(at));
        std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(4 * i), 3, tone);
    }
    return out;
}

constexpr auto kArm = static_cast<std::size_t>(body::Joint::left_upper_arm);
constexpr auto kElbow = static_cast<std::size_t>(body::Joint::left_lower_arm);

/// The left arm turned about its bone, which moves no joint of a straight arm.
body::Pose rolled(const TrackedBody& body, const body::Pose& pose, float angle) {
    const body::JointTransforms joints = body::forward_kinematics(body.skeleton(), pose);
    const Vec3f bone = (joints[kElbow].translation - joints[kArm].translation).normalized();
    const auto parent = static_cast<std::size_t>(*body::joint_parent(body::Joint::left_upper_arm));
    const Vec3f axis = joints[parent].rotation.conjugate() * bone;
    body::Pose out = pose;
    out.rotations[kArm] = (body::from_rotation_vector(angle * axis) * out.rotations[kArm]);
    return out;
}

/// Angle by which the left upper arm is turned about its bone.
float roll_between(const TrackedBody& body, const body::Pose& a, const body::Pose& b) {
    const body::JointTransforms one = body::forward_kinematics(body.skeleton(), a);
    const body::JointTransforms two = body::forward_kinematics(body.skeleton(), b);
    const Vec3f bone = (two[kElbow].translation - two[kArm].translation).normalized();
    return body::rotation_vector(two[kArm].rotation * one[kArm].rotation.conjugate()).dot(bone);
}

class SkinMarksTest : public testing::Test {
  protected:
    /// Knows the marks of `standing`, then sees the arm rolled, in another light.
    SkinMarksTest() : picture_(camera()) { show(standing(), 1.0f); }
    void show(const body::Pose& pose, float light) {
        seen_ = std::make_unique<SelfSeen>(pose);
        const std::vector<std::uint8_t> rgba = painted(seen_->body, pose, light);
        picture_.take(rgba.data(), {0, 0}, {10000, 10000});
    }
    [[nodiscard]] SeenPerson seen() const {
        SeenPerson out = seen_->seen();
        out.picture = &picture_;
        return out;
    }
    [[nodiscard]] static std::size_t sum(const std::array<std::uint16_t, body::kJointCount>& of) {
        return std::accumulate(of.begin(), of.end(), std::size_t{0});
    }

    TrackedBody body_{adult()};
    GreyPicture picture_;
    std::unique_ptr<SelfSeen> seen_;
};

TEST_F(SkinMarksTest, FindsInTheSamePictureWhatItLearned) {
    SkinMarks marks(body_, {});
    marks.find(seen(), standing());
    EXPECT_TRUE(marks.pulls().empty()) << "nothing was learned yet";
    marks.learn(seen(), standing(), 0.033f);
    marks.find(seen(), standing());
    ASSERT_GT(marks.pulls().size(), 10u);
    EXPECT_EQ(sum(marks.counts().found), sum(marks.counts().sought));
    PosedBody posed = body_.blank();
    body_.pose(standing(), posed);
    for (const SkinPull& pull : marks.pulls())
        for (const Vec3f& along : pull.along)
            EXPECT_LT(std::abs(along.dot(posed.positions[pull.vertex])), 1e-3f);
    marks.reset();
    marks.find(seen(), standing());
    EXPECT_TRUE(marks.pulls().empty());
}

TEST_F(SkinMarksTest, TurnAnArmAboutItsBoneInAnotherLight) {
    SkinMarks marks(body_, {});
    marks.learn(seen(), standing(), 0.033f);
    const body::Pose truth = rolled(body_, standing(), 0.2f);
    show(truth, 0.6f);
    Registration registration(body_, grid_camera());
    MotionPrior motion;
    motion.pose = standing();
    motion.turn.fill(0.35);
    const auto registered = [&](bool colour) {
        body::Pose pose = standing();
        SeenPerson with = seen();
        marks.find(with, pose);
        EXPECT_GT(marks.pulls().size(), 8u);
        if (colour) with.pulls = marks.pulls();
        for (int step = 0; step < 4; ++step)
            (void)registration.step(with, {}, &motion, pose);
        return std::abs(roll_between(body_, pose, truth));
    };
    // Of 0.2 rad depth leaves 0.10 of this smooth arm, colour 0.075; more weight leaves no less.
    const float by_depth = registered(false);
    EXPECT_LT(registered(true), 0.85f * by_depth);
}

/// Places of one bone only: correctives and shared skin are left out of derivatives.
TEST_F(SkinMarksTest, ResidualsChangeAsTheirDerivativesSay) {
    SkinMarks marks(body_, {});
    marks.learn(seen(), standing(), 0.033f);
    show(rolled(body_, standing(), 0.1f), 1.0f);
    marks.find(seen(), standing());
    PosedBody posed = body_.blank(), moved = body_.blank();
    body_.pose(standing(), posed);
    const auto place = [](const PosedBody& where, const SkinPull& pull) {
        return Vec3f(where.positions[pull.vertex] + where.rotations[pull.vertex] * pull.offset);
    };
    int tested = 0;
    for (SkinPull pull : marks.pulls()) {
        if (body_.level().skin.weights[pull.vertex][0] < 0.99f ||
            body_.level().correctives.weights[pull.vertex].cwiseAbs().maxCoeff() > 5e-3f)
            continue;
        ++tested;
        pull.offset = Vec3f(0.01f, -0.02f, 0.005f);
        const std::int32_t corner = body_.corner_of(pull.vertex);
        PlaceMotion motion;
        body_.motion(posed, corner / 3, TrackedBody::weights_of(corner), place(posed, pull),
                     pull.along[0], motion);
        Eigen::VectorXd row = Eigen::VectorXd::Zero(body::kPoseUnknowns);
        for (std::size_t b = 0; b < static_cast<std::size_t>(motion.count); ++b)
            row.segment<3>(motion.start[b]) = motion.block[b].cast<double>();
        for (int u = 0; u < body::kPoseUnknowns; ++u) {
            constexpr double kStep = 2e-3;
            const auto residual = [&](double by) {
                Eigen::VectorXd step = Eigen::VectorXd::Zero(body::kPoseUnknowns);
                step[u] = by;
                body_.pose(body::moved_pose(standing(), step.data()), moved);
                return static_cast<double>(pull.along[0].dot(place(moved, pull)));
            };
            ASSERT_NEAR(row[u], (residual(kStep) - residual(-kStep)) / (2.0 * kStep), 6e-3)
                << "vertex " << pull.vertex << ", unknown " << u;
        }
    }
    EXPECT_GT(tested, 3);
}

TEST_F(SkinMarksTest, WithoutColourOrWeightNothingIsPulled) {
    SkinMarks marks(body_, {});
    marks.learn(seen(), standing(), 0.033f);
    picture_.take(nullptr, {0, 0}, {10000, 10000});
    marks.find(seen(), standing());
    EXPECT_TRUE(marks.pulls().empty());
    show(standing(), 1.0f);
    MarkOptions off;
    off.weight = 0.0f;
    SkinMarks none(body_, off);
    none.learn(seen(), standing(), 0.033f);
    none.find(seen(), standing());
    EXPECT_TRUE(none.pulls().empty());
}

TEST(GreyPicture, SmoothsWithinItsBoxAndKeepsFlatOnesFlat) {
    const imaging::Intrinsics small{8, 6, 10.0, 10.0, 3.5, 2.5, {}};
    GreyPicture picture(small);
    std::vector<std::uint8_t> rgba(8 * 6 * 4, 100);
    picture.take(rgba.data(), {-5, -5}, {50, 50});
    ASSERT_FALSE(picture.empty());
    EXPECT_EQ(picture.low(), (std::array<int, 2>{1, 1}));
    EXPECT_EQ(picture.high(), (std::array<int, 2>{6, 4}));
    EXPECT_EQ(picture.values()[2 * 8 + 3], 1600);
    rgba[4 * (2 * 8 + 3)] = rgba[4 * (2 * 8 + 3) + 1] = rgba[4 * (2 * 8 + 3) + 2] = 200;
    picture.take(rgba.data(), {2, 1}, {5, 4});
    EXPECT_EQ(picture.values()[2 * 8 + 3], 2000);
    EXPECT_EQ(picture.values()[2 * 8 + 2], 1800);
    EXPECT_EQ(picture.values()[1 * 8 + 2], 1700);
    picture.take(rgba.data(), {6, 1}, {5, 4});
    EXPECT_TRUE(picture.empty());
}

} // namespace
} // namespace toile::body_tracker
