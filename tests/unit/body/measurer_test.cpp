// Measurements of the committed avatars: invariants, smoothness, repeatability over poses.
#include "body/measurer.h"

#include "body/skinning.h"
#include "support/shared_data.h"
#include "support/throws.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace toile::body {
namespace {

BodyModel avatar(const std::string& id) {
    return load_body_model(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / id);
}

std::vector<const MeasurementDefinition*> all_definitions() {
    std::vector<const MeasurementDefinition*> out;
    for (const MeasurementDefinition& d : measurement_definitions())
        out.push_back(&d);
    return out;
}

double value(const Measurements& measurements, std::string_view name) {
    for (const Measurement& m : measurements)
        if (m.name == name) return m.value_m;
    ADD_FAILURE() << name << " was not measured";
    return 0.0;
}

TEST(MeasurementDefinitions, AreManyAndNamedOnce) {
    std::set<std::string_view> names, columns;
    std::size_t iso = 0;
    for (const MeasurementDefinition& d : measurement_definitions()) {
        EXPECT_TRUE(names.insert(d.name).second) << d.name << " stands twice";
        EXPECT_TRUE(d.ansur_column.empty() || columns.insert(d.ansur_column).second) << d.name;
        EXPECT_FALSE(d.text.empty()) << d.name;
        iso += d.name.starts_with("ansur_") ? 0 : 1;
    }
    EXPECT_GE(iso, 30u);
}

TEST(MeasurementDefinitions, AWrongNameIsAnsweredWithASimilarOne) {
    EXPECT_ERROR((void)measurement_definition("waist_grith"), "did you mean 'waist_girth'");
}

TEST(MeasurementDefinitions, ColumnsAreThoseOfTheSurvey) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "ansur2");
    std::ifstream file(folder / "ANSUR_II_FEMALE_Public.csv");
    std::string head;
    std::getline(file, head);
    std::set<std::string> columns;
    std::istringstream in(head);
    for (std::string column; std::getline(in, column, ',');)
        columns.insert(column);
    for (const MeasurementDefinition& d : measurement_definitions())
        EXPECT_TRUE(d.ansur_column.empty() || columns.count(std::string(d.ansur_column)) == 1)
            << d.ansur_column;
}

TEST(Landmarks, HaveNamesAndOppositesBothWays) {
    for (std::size_t i = 0; i < kLandmarkCount; ++i) {
        const auto landmark = static_cast<Landmark>(i);
        EXPECT_EQ(landmark_from_name(landmark_name(landmark)), landmark);
        EXPECT_EQ(opposite(opposite(landmark)), landmark);
        std::string name(landmark_name(landmark));
        if (name.starts_with("left_"))
            name.replace(0, 4, "right");
        else if (name.starts_with("right_"))
            name.replace(0, 5, "left");
        EXPECT_EQ(landmark_name(opposite(landmark)), name);
    }
}

class MeasuredAvatar : public testing::TestWithParam<const char*> {
  protected:
    BodyModel model_ = avatar(GetParam());
    Measurer measurer_{model_};
    Measurements rest_ = measurer_.measure(model_.rest.positions, model_.skeleton);
};

TEST_P(MeasuredAvatar, StandsInItsFileAsMeasured) {
    EXPECT_EQ(model_.measurements.size(), rest_.size());
    for (const Measurement& m : rest_)
        EXPECT_NEAR(model_.measurements.at(std::string(m.name)), m.value_m, 6e-5) << m.name;
}

TEST_P(MeasuredAvatar, IsAsAPersonIs) {
    for (const Measurement& m : rest_) {
        EXPECT_GT(m.value_m, 0.05) << m.name;
        EXPECT_GE(m.confidence, 0.3) << m.name;
        EXPECT_LE(m.confidence, 1.0) << m.name;
    }
    const auto rising = [this](std::initializer_list<const char*> names) {
        double last = 0.0;
        for (const char* name : names) {
            EXPECT_GT(value(rest_, name), last) << name;
            last = value(rest_, name);
        }
    };
    rising({"ankle_height", "knee_height", "crotch_height", "hip_height", "ansur_waist_height",
            "waist_height", "bust_height", "armpit_height", "shoulder_height", "cervical_height",
            "stature"});
    rising(
        {"minimum_leg_girth", "lower_knee_girth", "mid_thigh_girth", "thigh_girth", "hip_girth"});
    rising({"wrist_girth", "forearm_girth", "upper_arm_girth", "neck_girth", "neck_base_girth"});
    rising({"under_bust_girth", "bust_girth", "trunk_circumference"});
    rising({"waist_girth", "high_hip_girth", "hip_girth"});
    rising(
        {"shoulder_length", "shoulder_width", "back_shoulder_width", "cervical_to_wrist_length"});
    rising({"waist_to_hip", "back_waist_length", "front_waist_length", "upper_body_length"});
    // Two ways to one length.
    EXPECT_NEAR(value(rest_, "upper_arm_length") + value(rest_, "lower_arm_length"),
                value(rest_, "arm_length"), 1e-6);
    EXPECT_NEAR(value(rest_, "cervical_height") - value(rest_, "crotch_height"),
                value(rest_, "trunk_length"), 1e-5);
}

TEST_P(MeasuredAvatar, GrowsInProportion) {
    const float scale = 1.2f;
    std::vector<Vec3f> positions = model_.rest.positions;
    Skeleton skeleton = model_.skeleton;
    for (Vec3f& p : positions)
        p *= scale;
    for (Vec3f& p : skeleton.rest_positions)
        p *= scale;
    const Measurements grown = measurer_.measure(positions, skeleton);
    for (std::size_t i = 0; i < rest_.size(); ++i)
        EXPECT_NEAR(grown[i].value_m / rest_[i].value_m, static_cast<double>(scale), 2e-4)
            << rest_[i].name;
}

TEST_P(MeasuredAvatar, MayFaceAnyWay) {
    const Quatf turn(Eigen::AngleAxisf(0.8f, Vec3f::UnitY()));
    std::vector<Vec3f> positions;
    for (const Vec3f& p : model_.rest.positions)
        positions.emplace_back(turn * p + Vec3f(0.4f, 0.0f, -1.0f));
    Pose pose = rest_pose(model_.skeleton);
    pose.hips_position = turn * pose.hips_position + Vec3f(0.4f, 0.0f, -1.0f);
    pose.rotations[0] = turn;
    const Figure figure = measurer_.figure(positions, forward_kinematics(model_.skeleton, pose));
    const Measurements turned = measure(figure, all_definitions());
    for (std::size_t i = 0; i < rest_.size(); ++i)
        EXPECT_NEAR(turned[i].value_m, rest_[i].value_m, 2e-4) << rest_[i].name;
}

TEST_P(MeasuredAvatar, LaysTapesThatAreAsLongAsTheySay) {
    const Figure figure = measurer_.figure(model_.rest.positions, model_.skeleton);
    for (const LaidMeasurement& m : lay_tapes(figure, all_definitions())) {
        double length = 0.0;
        for (const geometry::Loop& tape : m.reading.tapes)
            length += tape.length();
        if (m.definition->name != "ansur_span") { // drawn on one side only
            EXPECT_NEAR(length, m.reading.value_m, 1e-5) << m.definition->name;
        }
        // Where nothing but the measured part is near, the whole surface tells the same.
        const std::set<std::string_view> beside_the_arms = {"upper_chest_girth", "chest_girth"};
        if (m.reading.cut && beside_the_arms.count(m.definition->name) == 0) {
            const double again =
                girth_at_same_place(m.reading, model_.rest.positions, model_.rest.triangles);
            EXPECT_NEAR(again, m.reading.value_m, 1e-5) << m.definition->name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Committed, MeasuredAvatar, testing::Values("woman", "man", "mannequin"),
                         [](const auto& named) { return std::string(named.param); });

TEST(Measurer, ChangesSmoothlyWithTheShape) {
    const BodyModel woman = avatar("woman"), man = avatar("man");
    const Measurer measurer(woman);
    constexpr int kSteps = 60;
    std::vector<Measurements> values;
    for (int k = 0; k <= kSteps; ++k) {
        const float t = static_cast<float>(k) / kSteps;
        std::vector<Vec3f> positions;
        for (std::size_t v = 0; v < woman.rest.positions.size(); ++v)
            positions.emplace_back((1.0f - t) * woman.rest.positions[v] +
                                   t * man.rest.positions[v]);
        Skeleton skeleton;
        for (std::size_t j = 0; j < kJointCount; ++j)
            skeleton.rest_positions[j] =
                (1.0f - t) * woman.skeleton.rest_positions[j] + t * man.skeleton.rest_positions[j];
        values.push_back(measurer.measure(positions, skeleton));
    }
    // The change from step to step changes little itself: no jump hides in 1 mm.
    for (std::size_t i = 0; i < values[0].size(); ++i)
        for (int k = 1; k < kSteps; ++k) {
            const double bend =
                values[k + 1][i].value_m - 2.0 * values[k][i].value_m + values[k - 1][i].value_m;
            EXPECT_LT(std::abs(bend), 0.001) << values[0][i].name << " at step " << k;
        }
}

TEST(Measurer, RefusesAModelWithoutLandmarks) {
    BodyModel model = avatar("mannequin");
    model.landmarks.erase("left_shoulder");
    EXPECT_ERROR(Measurer{model}, "lacks the landmark 'left_shoulder'");
}

/// Largest change of a girth, and which one it is.
struct Change {
    double metres = 0.0;
    std::string_view name;
};
Change largest_change(const Measurements& before, const Measurements& after) {
    Change out;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (measurement_definition(before[i].name).kind != MeasurementKind::girth) continue;
        const double change = std::abs(after[i].value_m - before[i].value_m);
        if (change > out.metres) out = {change, before[i].name};
    }
    return out;
}

/// Girths in a pose, posed by dual quaternions: most that one may change measured as it stands, and
/// brought back into the rest pose (by the inverse of another skinning: this is no round trip).
struct Limits {
    double standing, unposed;
};
void expect_repeatable(const char* what, const std::map<Joint, Quatf>& turns,
                       const Limits& limits) {
    const BodyModel model = avatar("woman");
    const Measurer measurer(model);
    Pose pose = rest_pose(model.skeleton);
    for (const auto& [joint, turn] : turns)
        pose.rotations[static_cast<std::size_t>(joint)] = turn;
    const JointTransforms world = forward_kinematics(model.skeleton, pose);
    std::vector<Vec3f> positions(model.rest.positions.size());
    const SkinnedSurface surface(model.rest.positions, {}, model.skin.joints, model.skin.weights);
    surface.pose(skinning_transforms(model.skeleton, world), SkinningMethod::dual_quaternion,
                 VectorRows(std::span<Vec3f>(positions)), {});
    const Measurements rest = measurer.measure(model.rest.positions, model.skeleton);
    const Measurements posed = measure(measurer.figure(positions, world), all_definitions());
    for (std::size_t i = 0; i < rest.size(); ++i)
        EXPECT_LE(posed[i].confidence, rest[i].confidence) << rest[i].name;
    const Change standing = largest_change(rest, posed);
    EXPECT_LT(standing.metres, limits.standing) << standing.name;
    const Change unposed = largest_change(
        rest, measurer.measure(measurer.unposed(positions, model.skeleton, world), model.skeleton));
    EXPECT_LT(unposed.metres, limits.unposed) << unposed.name;
    std::cout << what << ": girths change by at most " << 1000.0 * standing.metres << " mm ("
              << standing.name << "), unposed by " << 1000.0 * unposed.metres << " mm ("
              << unposed.name << ")\n";
}

Quatf about(const Vec3f& axis, float degrees) {
    return Quatf(Eigen::AngleAxisf(degrees * std::numbers::pi_v<float> / 180.0f, axis));
}

TEST(MeasurerInPoses, ArmsLowered) {
    expect_repeatable("arms lowered by 20 degrees",
                      {{Joint::left_upper_arm, about(Vec3f::UnitZ(), -20)},
                       {Joint::right_upper_arm, about(Vec3f::UnitZ(), 20)}},
                      {0.03, 0.003});
}
TEST(MeasurerInPoses, ArmsRaised) {
    expect_repeatable("arms raised by 30 degrees",
                      {{Joint::left_upper_arm, about(Vec3f::UnitZ(), 30)},
                       {Joint::right_upper_arm, about(Vec3f::UnitZ(), -30)}},
                      {0.055, 0.007});
}
TEST(MeasurerInPoses, Walking) {
    expect_repeatable("a step of 25 degrees",
                      {{Joint::left_upper_leg, about(Vec3f::UnitX(), -25)},
                       {Joint::right_upper_leg, about(Vec3f::UnitX(), 20)},
                       {Joint::right_lower_leg, about(Vec3f::UnitX(), 15)},
                       {Joint::left_upper_arm, about(Vec3f::UnitX(), 20)},
                       {Joint::right_upper_arm, about(Vec3f::UnitX(), -20)}},
                      {0.015, 0.009});
}
TEST(MeasurerInPoses, LeaningAndTurning) {
    expect_repeatable("the trunk leaning by 15 and turned by 20 degrees",
                      {{Joint::hips, about(Vec3f::UnitY(), 60)},
                       {Joint::spine, about(Vec3f::UnitX(), 15)},
                       {Joint::chest, about(Vec3f::UnitY(), 20)}},
                      {0.035, 0.008});
}

} // namespace
} // namespace toile::body
