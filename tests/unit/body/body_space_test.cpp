// The shipped space of adult bodies: shapes, priors, levels, poses.
#include "body/body_space.h"

#include "body/body_from_numbers.h"
#include "body/joint_limits.h"
#include "body/pose_tables.h"
#include "support/throws.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

fs::path adult_folder() {
    return fs::path(TOILE_SOURCE_DIR) / "avatars" / "adult";
}

const BodySpace& adult() {
    static const BodySpace kSpace = BodySpace::load(adult_folder());
    return kSpace;
}

double farthest(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    double out = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v)
        out = std::max(out, static_cast<double>((a[v] - b[v]).norm()));
    return out;
}

std::vector<double> some_coefficients() {
    return {1.2, -0.8, 0.5, 1.0, -1.5, 0.3, 0.7, -0.4};
}

TEST(BodySpaceShape, IsTheMeanAtZeroAndLinearFromThere) {
    const auto& model = adult().model();
    EXPECT_LT(farthest(adult().shape({}).positions, model.rest.positions), 1e-6);
    const std::vector<double> one = {1.0}, two = {2.0};
    const auto a = adult().shape(one), b = adult().shape(two);
    // Up to the height that the floor takes off.
    const auto step = [&](std::size_t v) {
        return Vec3f(b.positions[v] - 2.0f * a.positions[v] + model.rest.positions[v]);
    };
    for (std::size_t v = 1; v < model.rest.positions.size(); ++v)
        EXPECT_LT((step(v) - step(0)).norm(), 1e-5f);
}

TEST(BodySpaceShape, StandsOnTheFloorWithItsJointsInside) {
    const auto shape = adult().shape(some_coefficients());
    float floor = 1.0f, top = 0.0f;
    for (const auto& p : shape.positions) {
        floor = std::min(floor, p.y());
        top = std::max(top, p.y());
    }
    EXPECT_NEAR(floor, 0.0f, 1e-6f);
    for (const auto& j : shape.skeleton.rest_positions) {
        EXPECT_GT(j.y(), 0.0f);
        EXPECT_LT(j.y(), top);
    }
}

TEST(BodySpaceShape, CoefficientsComeBack) {
    const auto wanted = some_coefficients();
    const Eigen::VectorXd found = adult().coefficients(adult().shape(wanted).positions);
    for (int c = 0; c < found.size(); ++c)
        EXPECT_NEAR(found[c], c < static_cast<int>(wanted.size()) ? wanted[c] : 0.0, 2e-3);
    EXPECT_ERROR(static_cast<void>(adult().coefficients(std::vector<Vec3f>(3))), "topology");
}

TEST(BodySpaceShape, MoreCoefficientsThanComponentsAreRefused) {
    const std::vector<double> many(static_cast<std::size_t>(adult().component_count()) + 1, 0.0);
    EXPECT_ERROR(static_cast<void>(adult().shape(many)), "coefficients");
}

TEST(BodySpacePrior, TellsTheSexesApart) {
    const auto &woman = adult().prior(Sex::female), &man = adult().prior(Sex::male);
    EXPECT_GT((woman.mean - man.mean).norm(), 1.0);
    const auto stature = [](const CoefficientPrior& prior) {
        const auto shape =
            adult().shape({prior.mean.data(), static_cast<std::size_t>(prior.mean.size())});
        float top = 0.0f;
        for (const auto& p : shape.positions)
            top = std::max(top, p.y());
        return top;
    };
    EXPECT_NEAR(stature(woman), 1.6285f, 0.01f); // ANSUR II
    EXPECT_NEAR(stature(man), 1.7562f, 0.01f);
}

TEST(BodySpaceLevels, AreClosedAndCarryTheFullSurface) {
    ASSERT_EQ(adult().levels().size(), 2u);
    const auto& full = adult().model().rest.positions;
    const std::array<std::size_t, 2> wanted = {3000, 1000};
    for (std::size_t l = 0; l < 2; ++l) {
        const BodyLevel& level = adult().levels()[l];
        EXPECT_NEAR(static_cast<double>(level.vertices.size()), static_cast<double>(wanted[l]),
                    10.0);
        std::vector<Vec3f> positions;
        for (const auto v : level.vertices)
            positions.push_back(full[v]);
        EXPECT_TRUE(geometry::check_topology(positions, level.triangles).closed());
        double sum = 0.0;
        for (std::size_t v = 0; v < full.size(); ++v) {
            const Triangle& t = level.triangles[level.triangle[v]];
            Vec3f on = Vec3f::Zero();
            for (std::size_t k = 0; k < 3; ++k)
                on += level.barycentric[v][static_cast<int>(k)] * positions[t[k]];
            sum += static_cast<double>((on - full[v]).norm());
        }
        EXPECT_LT(sum / static_cast<double>(full.size()), l == 0 ? 0.002 : 0.005);
    }
}

class AdultPose : public testing::Test {
  protected:
    const BodyModel& model_ = adult().model();
    PoseTables tables_ = load_pose_tables(model_);
    ScapeModel scape_{model_, tables_.deformation};
    BodyShape shape_ = adult().shape(some_coefficients());
    std::vector<Vec3f> posed_ = std::vector<Vec3f>(model_.rest.positions.size());
    std::vector<Vec3f> other_ = posed_;
};

TEST_F(AdultPose, RestPoseGivesTheRestShapeInBothForms) {
    ScapeBody body(scape_, shape_);
    body.pose(rest_pose(shape_.skeleton), posed_);
    EXPECT_LT(farthest(posed_, shape_.positions), 1e-4);
    const CorrectiveSkin baked(shape_, model_.skin, tables_.correctives);
    baked.pose(rest_pose(shape_.skeleton), posed_);
    EXPECT_LT(farthest(posed_, shape_.positions), 1e-5);
}

TEST_F(AdultPose, MovesRigidlyWithItsHips) {
    Random random(11);
    const Pose pose = random_pose(shape_.skeleton, random);
    ScapeBody body(scape_, shape_);
    body.pose(pose, posed_);
    const RigidTransform motion = {Quatf(Eigen::AngleAxisf(1.1f, Vec3f(1, 2, -1).normalized())),
                                   Vec3f(0.3f, -0.2f, 1.0f)};
    Pose moved = pose;
    moved.rotations[0] = motion.rotation * pose.rotations[0];
    moved.hips_position = motion * pose.hips_position;
    body.pose(moved, other_);
    for (auto& p : posed_)
        p = motion * p;
    EXPECT_LT(farthest(posed_, other_), 2e-4);
}

TEST_F(AdultPose, WhatMatricesDoToNormalsMovesNothing) {
    std::vector<Mat3f> matrices(model_.rest.triangles.size(), Mat3f::Identity());
    scape_.solve(matrices, model_.rest.positions, posed_);
    EXPECT_LT(farthest(posed_, model_.rest.positions), 1e-4);
    for (std::size_t t = 0; t < matrices.size(); ++t) {
        const Tangents E = tangents(model_.rest.positions, model_.rest.triangles[t]);
        EXPECT_LT((E.transpose() * E - Eigen::Matrix2f::Identity()).norm(), 1e-5f);
        const Vec3f normal = E.col(0).cross(E.col(1));
        matrices[t] += 0.5f * Vec3f(1, 2, 3) * normal.transpose();
    }
    scape_.solve(matrices, model_.rest.positions, other_);
    EXPECT_LT(farthest(posed_, other_), 1e-4);
}

TEST_F(AdultPose, BakedFormIsNearSCAPE) {
    // Its own test poses are in training.json; here other ones, and another shape than it learned.
    Random random(12);
    ScapeBody body(scape_, shape_);
    const CorrectiveSkin baked(shape_, model_.skin, tables_.correctives);
    double sum = 0.0;
    constexpr int kPoses = 8;
    for (int i = 0; i < kPoses; ++i) {
        const Pose pose = random_pose(shape_.skeleton, random);
        body.pose(pose, posed_);
        baked.pose(pose, other_);
        for (std::size_t v = 0; v < posed_.size(); ++v)
            sum += static_cast<double>((posed_[v] - other_[v]).norm());
    }
    EXPECT_LT(sum / static_cast<double>(kPoses * posed_.size()), 0.002);
}

TEST_F(AdultPose, TablesOfAnotherModelAreRefused) {
    BodyModel other = model_;
    other.rest.triangles.pop_back();
    EXPECT_ERROR(static_cast<void>(load_pose_tables(other)), "fit");
}

BodyFromNumbers from_numbers(Sex sex, const NamedLengths& wanted) {
    std::vector<std::string> names;
    for (const auto& [name, value] : wanted)
        names.push_back(name);
    return body_from_numbers(adult(), sex, wanted, measure_by_definitions(adult().model(), names));
}

TEST(BodyNumbers, HitsWhatIsAskedWithinTwoMillimetres) {
    const NamedLengths wanted = {{"stature", 1.68}, {"bust_girth", 0.92}, {"hip_girth", 1.0}};
    const auto made = from_numbers(Sex::female, wanted);
    for (const auto& [name, value] : wanted)
        EXPECT_NEAR(made.measurements.at(name), value, 0.002) << name;
    EXPECT_LT(made.deviations, 3.0);
}

TEST(BodyNumbers, RefusesWhatNobodyIsByName) {
    EXPECT_ERROR(
        static_cast<void>(from_numbers(Sex::male, {{"stature", 1.75}, {"cervical_height", 1.0}})),
        "nobody measures like that");
    EXPECT_ERROR(static_cast<void>(from_numbers(Sex::male, {{"tail_length", 0.3}})), "tail_length");
}

} // namespace
} // namespace toile::body
