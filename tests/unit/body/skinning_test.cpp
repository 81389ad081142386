#include "body/skinning.h"

#include "core/error.h"
#include "unit/body/body_fixture.h"

#include <cmath>
#include <gtest/gtest.h>

namespace toile::body {
namespace {

using test::adult_skeleton;
using test::turn;

constexpr auto kLeftUpperArm = static_cast<std::size_t>(Joint::left_upper_arm);
constexpr auto kLeftLowerArm = static_cast<std::size_t>(Joint::left_lower_arm);

/// A tube of 5 cm radius along the left arm whose weights pass smoothly from upper to lower arm.
struct Tube {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
    std::vector<std::array<std::uint16_t, 4>> joints;
    std::vector<std::array<float, 4>> weights;
    static constexpr std::size_t kRings = 41;
    static constexpr std::size_t kSides = 24;
    static constexpr float kRadius = 0.05f;
};

Tube arm_tube(const Skeleton& skeleton) {
    const Vec3f elbow = skeleton.rest(Joint::left_lower_arm);
    const Vec3f axis = (skeleton.rest(Joint::left_hand) - elbow).normalized();
    const Vec3f u = axis.unitOrthogonal();
    const Vec3f w = axis.cross(u);
    Tube tube;
    for (std::size_t ring = 0; ring < Tube::kRings; ++ring) {
        const float t = static_cast<float>(ring) / (Tube::kRings - 1); // 0..1 over 20 cm
        for (std::size_t side = 0; side < Tube::kSides; ++side) {
            const float a = 6.2831853f * static_cast<float>(side) / Tube::kSides;
            const Vec3f normal = std::cos(a) * u + std::sin(a) * w;
            tube.normals.push_back(normal);
            tube.positions.push_back(elbow + (0.2f * t - 0.1f) * axis + Tube::kRadius * normal);
            tube.joints.push_back({kLeftUpperArm, kLeftLowerArm, 0, 0});
            tube.weights.push_back({1.0f - t, t, 0.0f, 0.0f});
        }
    }
    return tube;
}

struct Posed {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
};

Posed posed(const Tube& tube, const JointTransforms& skinning, SkinningMethod method) {
    const SkinnedSurface surface(tube.positions, tube.normals, tube.joints, tube.weights);
    Posed out{std::vector<Vec3f>(tube.positions.size()), std::vector<Vec3f>(tube.positions.size())};
    surface.pose(skinning, method, VectorRows(std::span(out.positions)),
                 VectorRows(std::span(out.normals)));
    return out;
}

JointTransforms skinning_of(const Skeleton& skeleton, const Pose& pose) {
    return skinning_transforms(skeleton, forward_kinematics(skeleton, pose));
}

/// Mean distance of the middle ring from its own centre.
float middle_radius(const std::vector<Vec3f>& positions) {
    const std::size_t begin = (Tube::kRings / 2) * Tube::kSides;
    Vec3f centre = Vec3f::Zero();
    for (std::size_t i = 0; i < Tube::kSides; ++i)
        centre += positions[begin + i] / static_cast<float>(Tube::kSides);
    float sum = 0.0f;
    for (std::size_t i = 0; i < Tube::kSides; ++i)
        sum += (positions[begin + i] - centre).norm();
    return sum / static_cast<float>(Tube::kSides);
}

class Skinning : public testing::TestWithParam<SkinningMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, Skinning,
                         testing::Values(SkinningMethod::linear_blend,
                                         SkinningMethod::dual_quaternion));

TEST_P(Skinning, TheRestPoseIsTheIdentity) {
    const Skeleton skeleton = adult_skeleton();
    const Tube tube = arm_tube(skeleton);
    const Posed out = posed(tube, skinning_of(skeleton, rest_pose(skeleton)), GetParam());
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        EXPECT_LT((out.positions[v] - tube.positions[v]).norm(), 1e-6f);
        EXPECT_LT((out.normals[v] - tube.normals[v]).norm(), 1e-6f);
    }
}

TEST_P(Skinning, ARigidMotionOfTheHipsMovesTheSurfaceRigidly) {
    const Skeleton skeleton = adult_skeleton();
    const Tube tube = arm_tube(skeleton);
    Pose pose = rest_pose(skeleton);
    pose.hips_position = Vec3f(1.0f, 0.7f, -2.0f);
    pose.rotations[0] = turn(Vec3f(1, 2, 3), 140.0f);
    const Posed out = posed(tube, skinning_of(skeleton, pose), GetParam());
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        const Vec3f expected =
            pose.rotations[0] * (tube.positions[v] - skeleton.rest(Joint::hips)) +
            pose.hips_position;
        EXPECT_LT((out.positions[v] - expected).norm(), 2e-6f);
        EXPECT_LT((out.normals[v] - pose.rotations[0] * tube.normals[v]).norm(), 2e-6f);
    }
}

TEST_P(Skinning, NegatedQuaternionsGiveTheSameSurface) {
    const Skeleton skeleton = adult_skeleton();
    const Tube tube = arm_tube(skeleton);
    Pose pose = rest_pose(skeleton);
    pose.rotations[kLeftLowerArm] = turn(Vec3f(0.2f, -1, 0.4f), 100.0f);
    const JointTransforms plain = skinning_of(skeleton, pose);
    JointTransforms negated = plain;
    negated[kLeftLowerArm].rotation.coeffs() *= -1.0f;
    const Posed a = posed(tube, plain, GetParam());
    const Posed b = posed(tube, negated, GetParam());
    for (std::size_t v = 0; v < tube.positions.size(); ++v)
        EXPECT_LT((a.positions[v] - b.positions[v]).norm(), 1e-6f);
}

TEST(SkinningVolume, DualQuaternionsKeepTheRadiusAtATwistWhereLinearBlendCollapses) {
    const Skeleton skeleton = adult_skeleton();
    const Tube tube = arm_tube(skeleton);
    const Vec3f axis = skeleton.offset(Joint::left_hand);
    for (const float degrees : {90.0f, 120.0f, 150.0f}) {
        Pose pose = rest_pose(skeleton);
        pose.rotations[kLeftLowerArm] = turn(axis, degrees);
        const JointTransforms skinning = skinning_of(skeleton, pose);
        const float linear =
            middle_radius(posed(tube, skinning, SkinningMethod::linear_blend).positions);
        const float dual =
            middle_radius(posed(tube, skinning, SkinningMethod::dual_quaternion).positions);
        // Half and half of two matrices that differ by an angle a shrinks to cos(a / 2).
        EXPECT_NEAR(linear, Tube::kRadius * std::cos(test::radians(degrees) / 2.0f), 1e-4f);
        EXPECT_NEAR(dual, Tube::kRadius, 1e-5f);
    }
}

TEST(SkinningInput, WeightOrderAndStrideDoNotMatter) {
    const Skeleton skeleton = adult_skeleton();
    const Tube tube = arm_tube(skeleton);
    Tube shuffled = tube;
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        std::swap(shuffled.joints[v][0], shuffled.joints[v][2]);
        std::swap(shuffled.weights[v][0], shuffled.weights[v][2]);
        shuffled.weights[v][3] = 0.0f;
        shuffled.joints[v][3] = 999; // unused, so it may be anything
    }
    Pose pose = rest_pose(skeleton);
    pose.rotations[kLeftLowerArm] = turn(Vec3f::UnitY(), -80.0f);
    const JointTransforms skinning = skinning_of(skeleton, pose);
    for (const auto method : {SkinningMethod::linear_blend, SkinningMethod::dual_quaternion}) {
        const Posed expected = posed(tube, skinning, method);
        const SkinnedSurface surface(shuffled.positions, {}, shuffled.joints, shuffled.weights);
        std::vector<float> rows(tube.positions.size() * 5, -7.0f);
        surface.pose(skinning, method, VectorRows(rows.data(), 5 * sizeof(float)), {});
        for (std::size_t v = 0; v < tube.positions.size(); ++v) {
            const Vec3f p(rows[5 * v], rows[5 * v + 1], rows[5 * v + 2]);
            EXPECT_LT((p - expected.positions[v]).norm(), 1e-6f);
            EXPECT_EQ(rows[5 * v + 3], -7.0f);
        }
    }
}

TEST(SkinningInput, BadSkinsAreRefusedByVertex) {
    const Skeleton skeleton = adult_skeleton();
    const auto refused = [&](auto&& spoil) {
        Tube tube = arm_tube(skeleton);
        spoil(tube);
        EXPECT_THROW(SkinnedSurface(tube.positions, tube.normals, tube.joints, tube.weights),
                     Error);
    };
    refused([](Tube& t) { t.weights[5] = {0, 0, 0, 0}; });
    refused([](Tube& t) { t.weights[5] = {2, -1, 0, 0}; });
    refused([](Tube& t) { t.weights[5][0] = std::nanf(""); });
    refused([](Tube& t) { t.joints[5][0] = 22; });
    refused([](Tube& t) { t.positions[5].y() = INFINITY; });
    refused([](Tube& t) { t.normals.pop_back(); });
}

} // namespace
} // namespace toile::body
