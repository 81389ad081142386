// The 22 joints of VRM 1.0's humanoid and rigid poses of them.
#pragma once

#include "core/types.h"

#include <array>
#include <optional>
#include <string_view>

namespace toile::body {

/// Parents before children; the order is that of the plugin boundary (abi/body.h).
enum class Joint : std::uint8_t {
    hips,
    spine,
    chest,
    upper_chest,
    neck,
    head,
    left_shoulder,
    left_upper_arm,
    left_lower_arm,
    left_hand,
    right_shoulder,
    right_upper_arm,
    right_lower_arm,
    right_hand,
    left_upper_leg,
    left_lower_leg,
    left_foot,
    left_toes,
    right_upper_leg,
    right_lower_leg,
    right_foot,
    right_toes,
};
inline constexpr std::size_t kJointCount = 22;

/// VRM name: "leftUpperArm".
[[nodiscard]] std::string_view joint_name(Joint joint);
[[nodiscard]] std::optional<Joint> joint_from_name(std::string_view name);
/// Nothing for the hips.
[[nodiscard]] std::optional<Joint> joint_parent(Joint joint);
/// The same joint of the other side; a joint of the midline itself.
[[nodiscard]] Joint opposite_joint(Joint joint);

/// Rest positions of one body's joints, metres, world frame of the rest pose (A pose, feet on
/// y = 0, facing +Z). At rest the axes of every joint are those of the world.
struct Skeleton {
    std::array<Vec3f, kJointCount> rest_positions;

    [[nodiscard]] const Vec3f& rest(Joint joint) const {
        return rest_positions[static_cast<std::size_t>(joint)];
    }
    /// From the parent's rest position to the joint's; for the hips, the rest position.
    [[nodiscard]] Vec3f offset(Joint joint) const;
};

/// Rotation of each joint relative to its parent (identity at rest), and where the hips are.
struct Pose {
    Vec3f hips_position = Vec3f::Zero();      ///< world, metres
    std::array<Quatf, kJointCount> rotations; ///< local; hips: world
    Pose() { rotations.fill(Quatf::Identity()); }
};

/// world_from_joint of every joint.
using JointTransforms = std::array<RigidTransform, kJointCount>;

/// The pose in which the body stands as modelled.
[[nodiscard]] Pose rest_pose(const Skeleton& skeleton);
[[nodiscard]] JointTransforms forward_kinematics(const Skeleton& skeleton,
                                                 const Pose& pose) noexcept;
/// Maps rest-surface points of a joint into the world: world_from_joint * joint_from_rest.
[[nodiscard]] JointTransforms skinning_transforms(const Skeleton& skeleton,
                                                  const JointTransforms& world) noexcept;

} // namespace toile::body
