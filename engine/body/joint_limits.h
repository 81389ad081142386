// How far people turn their joints, as axes and angles of our 22 joints.
#pragma once

#include "body/skeleton.h"
#include "core/random.h"

namespace toile::body {

/// Range of a joint about one axis of its own frame, radians; 0 is the rest pose (A pose).
struct AngleRange {
    float low = 0.0f, high = 0.0f;
};

/// Axes are those of the parent's frame, which at rest is the world's. Arms have axes of their own:
/// `along` the bone, `bend` = along x Z (an elbow's flexion), and Z.
struct JointLimits {
    bool follows_bone = false; ///< ranges are about along, bend, Z; else about X, Y, Z
    std::array<AngleRange, 3> range{};
};

/// Active range of motion of healthy adults: limbs AAOS (Greene and Heckman 1994) and Soucie et al.
/// 2011, spine White and Panjabi 1990, neck Youdas et al. 1992 shared by its two joints, clavicle
/// Kapandji. Shoulder flexion and abduction are those of arm and clavicle together, less the
/// clavicle's. Hips: nothing, they are the body's place.
[[nodiscard]] JointLimits joint_limits(Joint joint);

/// A rotation vector of `joint` (parent's frame) from coordinates in [-1, 1] of its ranges: 0 is
/// rest, 1 the high end, -1 the low end.
[[nodiscard]] Vec3f limited_rotation(const Skeleton& skeleton, Joint joint, const Vec3f& share);

/// All joints anywhere up to their limits, most of them near: shares are even in the unit ball.
[[nodiscard]] Pose random_pose(const Skeleton& skeleton, Random& random);

/// Left and right exchanged.
[[nodiscard]] Pose mirrored(const Pose& pose);

} // namespace toile::body
