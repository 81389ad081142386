// Tapes with derivatives, modifiers, the survey's statistics, components, flesh.
#include "body/ansur_paths.h"
#include "body/ansur_survey.h"
#include "body/flesh.h"
#include "body/held_out_modifiers.h"
#include "body/joint_limits.h"
#include "body/makehuman_modifiers.h"
#include "body/principal_components.h"
#include "body/tape.h"
#include "support/shared_data.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <numbers>

namespace toile::body {
namespace {

/// A closed tube of radii a (x) and b (z) around the y axis, 2 m high, many sides.
geometry::TriangleMesh tube(float a, float b) {
    constexpr std::uint32_t kSides = 400, kRings = 21;
    geometry::TriangleMesh out;
    for (std::uint32_t r = 0; r < kRings; ++r)
        for (std::uint32_t s = 0; s < kSides; ++s) {
            const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(s) / kSides;
            out.positions.emplace_back(a * std::sin(angle), 0.1f * static_cast<float>(r),
                                       b * std::cos(angle));
        }
    for (std::uint32_t r = 0; r + 1 < kRings; ++r)
        for (std::uint32_t s = 0; s < kSides; ++s) {
            const std::uint32_t i = r * kSides + s, j = r * kSides + (s + 1) % kSides;
            out.triangles.push_back({i, j, j + kSides});
            out.triangles.push_back({i, j + kSides, i + kSides});
        }
    return out;
}

TEST(Tape, ReadsTheGirthOfACylinder) {
    const auto mesh = tube(0.15f, 0.15f);
    const Measured girth =
        tape_girth(mesh.positions, mesh.triangles, Vec3f(0, 1.03f, 0), Vec3f::UnitY());
    EXPECT_NEAR(girth.value, 2.0 * std::numbers::pi * 0.15, 1e-4);
}

TEST(Tape, ItsSlopeIsThatOfDifferences) {
    const auto mesh = tube(0.2f, 0.12f);
    const auto read = [&](const std::vector<Vec3f>& p) {
        const std::uint32_t rider = 400 * 10;
        return tape_girth(p, mesh.triangles, p[rider] + Vec3f(0, 0.033f, 0), Vec3f::UnitY(),
                          &rider);
    };
    const Measured at = read(mesh.positions);
    // A smooth change of the whole tube: it flares, leans and rises.
    const auto change = [](const Vec3f& p) {
        return Vec3f(0.3f * p.x() + 0.1f * p.y(), 0.2f, p.z() * p.y());
    };
    double predicted = 0.0;
    for (const auto& [v, slope] : at.slope)
        predicted += static_cast<double>(slope.dot(change(mesh.positions[v])));
    constexpr float kStep = 1e-3f;
    std::vector<Vec3f> more = mesh.positions, less = mesh.positions;
    for (std::size_t v = 0; v < more.size(); ++v) {
        more[v] += kStep * change(mesh.positions[v]);
        less[v] -= kStep * change(mesh.positions[v]);
    }
    const double measured = (read(more).value - read(less).value) / (2.0 * kStep);
    EXPECT_NEAR(predicted, measured, 0.01 * std::abs(measured));
}

TEST(Modifiers, SlopesAreThoseOfDifferences) {
    const ModifierSet set;
    Eigen::VectorXd values(static_cast<int>(set.modifiers().size()));
    for (int i = 0; i < values.size(); ++i) {
        const auto& m = set.modifiers()[static_cast<std::size_t>(i)];
        values[i] = m.low + 0.3 * (m.high - m.low);
    }
    const Eigen::MatrixXd slopes = set.slopes(values);
    for (int i = 0; i < values.size(); ++i) {
        Eigen::VectorXd more = values, less = values;
        more[i] += 1e-5;
        less[i] -= 1e-5;
        const Eigen::VectorXd difference = (set.amounts(more) - set.amounts(less)) / 2e-5;
        EXPECT_LT((difference - slopes.col(i)).cwiseAbs().maxCoeff(), 1e-6)
            << set.modifiers()[static_cast<std::size_t>(i)].name;
    }
}

TEST(Modifiers, LeaveOutWhatIsKeptForTesting) {
    for (const auto& target : ModifierSet().targets())
        EXPECT_FALSE(held_out(target)) << target;
}

TEST(Survey, StatisticsAreThePublishedOnes) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "ansur2");
    const Statistics men = statistics(read_ansur(folder, Sex::male));
    EXPECT_NEAR(men.mean[0], 1.7562, 1e-4); // ansur2_summary.csv
    EXPECT_NEAR(men.deviation[0], 0.0686, 1e-4);
    EXPECT_NEAR(men.mean[1], 85.5, 0.05);
    EXPECT_NEAR(men.correlation(0, 0), 1.0, 1e-12);
}

TEST(Survey, HeavyPeopleHaveTheIndexAskedFor) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "ansur2");
    Random random(1);
    const auto heavy = heavy_people(read_ansur(folder, Sex::female), 40, 35.0, 45.0, random);
    for (int i = 0; i < heavy.rows(); ++i) {
        const double index = heavy(i, 1) / (heavy(i, 0) * heavy(i, 0));
        EXPECT_GT(index, 33.0); // the stature moves a little with the weight
        EXPECT_LT(index, 46.0);
    }
}

TEST(PrincipalComponents, FindAPlaneAndItsSpread) {
    Random random(3);
    Eigen::MatrixXf rows(400, 30);
    const Eigen::VectorXf a = Eigen::VectorXf::LinSpaced(30, 0.0f, 1.0f);
    Eigen::VectorXf b = Eigen::VectorXf::Ones(30);
    b -= a * (a.dot(b) / a.squaredNorm());
    for (int i = 0; i < rows.rows(); ++i)
        rows.row(i) = 2.0f * static_cast<float>(random.normal()) * a.normalized() +
                      0.5f * static_cast<float>(random.normal()) * b.normalized();
    Eigen::SparseMatrix<float> metric(30, 30);
    metric.setIdentity();
    const auto found = principal_components(rows, metric, 2);
    EXPECT_NEAR(found.deviation[0], 2.0, 0.2);
    EXPECT_NEAR(found.deviation[1], 0.5, 0.05);
    EXPECT_NEAR(found.components.col(0).dot(found.components.col(1)), 0.0f, 1e-4f);
    const Eigen::VectorXf row = rows.row(7);
    const Eigen::VectorXf again =
        found.mean + found.components * found.project(row, metric).cast<float>();
    EXPECT_LT((row - again).norm(), 1e-4f);
}

TEST(NearestRotation, FindsTheRotationWithinAStretch) {
    const Quatf turn(Eigen::AngleAxisf(2.0f, Vec3f(1, -2, 0.5f).normalized()));
    const Mat3f stretched =
        turn.toRotationMatrix() * Vec3f(1.3f, 0.8f, 1.0f).asDiagonal().toDenseMatrix();
    Quatf found = Quatf(Eigen::AngleAxisf(1.5f, Vec3f(1, -2, 0.5f).normalized()));
    for (int i = 0; i < 5; ++i)
        found = nearest_rotation(stretched, found);
    EXPECT_LT(found.angularDistance(turn), 1e-3f);
}

TEST(FleshOfTheWoman, KeepsItsRestAndInAPoseItsVolumeWithinFivePercent) {
    const BodyModel model =
        load_body_model(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / "woman");
    const Flesh flesh(model);
    const auto pose_with = [&](const Pose& pose) {
        return skinning_transforms(model.skeleton, forward_kinematics(model.skeleton, pose));
    };
    const auto rest = flesh.relax(pose_with(rest_pose(model.skeleton)));
    for (std::size_t v = 0; v < rest.size(); ++v)
        ASSERT_LT((rest[v] - model.rest.positions[v]).norm(), 1e-4f);
    Random random(5);
    const auto posed = flesh.relax(pose_with(random_pose(model.skeleton, random)));
    const double before = geometry::volume(model.rest);
    const double after = geometry::volume({posed, {}, model.rest.triangles});
    EXPECT_NEAR(after / before, 1.0, 0.05);
}

TEST(JointLimits, MirrorImagesOfPosesAreMirrored) {
    const BodyModel model =
        load_body_model(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / "man");
    for (std::size_t j = 1; j < kJointCount; ++j) {
        const auto joint = static_cast<Joint>(j);
        const Vec3f share(0.5f, -0.3f, 0.7f);
        const Vec3f here = limited_rotation(model.skeleton, joint, share);
        const Vec3f there = limited_rotation(model.skeleton, opposite_joint(joint), share);
        if (opposite_joint(joint) != joint) {
            EXPECT_LT((Vec3f(here.x(), -here.y(), -here.z()) - there).norm(), 1e-5f);
        }
    }
}

} // namespace
} // namespace toile::body
