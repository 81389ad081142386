#include "mesh_garment/weight_transfer.h"

#include <numbers>

namespace toile::mesh_garment {
namespace {

struct Turn {
    body::Joint joint;
    Vec3f axis; ///< world, at rest
    float degrees;
};

body::JointTransforms pose_of(const body::Skeleton& skeleton, std::initializer_list<Turn> turns) {
    body::Pose pose = body::rest_pose(skeleton);
    for (const Turn& turn : turns) {
        const float angle = turn.degrees * std::numbers::pi_v<float> / 180.0f;
        pose.rotations[static_cast<std::size_t>(turn.joint)] =
            Quatf(Eigen::AngleAxisf(angle, turn.axis));
    }
    return body::skinning_transforms(skeleton, body::forward_kinematics(skeleton, pose));
}

} // namespace

std::vector<body::JointTransforms> test_poses(const std::array<Vec3f, body::kJointCount>& joints) {
    using enum body::Joint;
    const body::Skeleton s{joints};
    const Vec3f x = Vec3f::UnitX();
    const Vec3f y = Vec3f::UnitY();
    const Vec3f z = Vec3f::UnitZ();
    return {
        // strides; a turn about -X swings a leg forward
        pose_of(s, {{left_upper_leg, x, -35}, {left_lower_leg, x, 15}, {right_upper_leg, x, 25}}),
        pose_of(s, {{right_upper_leg, x, -35}, {right_lower_leg, x, 15}, {left_upper_leg, x, 25}}),
        // legs apart, and one knee up
        pose_of(s, {{left_upper_leg, z, 20}, {right_upper_leg, z, -20}}),
        pose_of(s, {{left_upper_leg, x, -70}, {left_lower_leg, x, 80}}),
        // arms up to the side, forward, and down
        pose_of(s, {{left_upper_arm, z, 60}, {right_upper_arm, z, -60}}),
        pose_of(s, {{left_upper_arm, y, -70}, {right_upper_arm, y, 70}}),
        pose_of(s, {{left_upper_arm, z, -35}, {right_upper_arm, z, 35}}),
        // a bow and a twist
        pose_of(s, {{spine, x, 25}, {chest, x, 20}}),
        pose_of(s, {{spine, y, 25}, {chest, y, 15}}),
    };
}

} // namespace toile::mesh_garment
