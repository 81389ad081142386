// Ways in which people hold their arms and legs before a camera: where searches for a pose start.
#pragma once

#include "body/skeleton.h"

#include <span>

namespace toile::body {

/// Degrees of a left arm: the shoulder's and the upper arm's lift, the arm's way forward, the
/// elbow's bend, and the upper arm's turn about itself. The right arm mirrors it.
struct ArmPose {
    float collar = 0.0f, lift = 0.0f, forward = 0.0f, elbow = 0.0f, turn = 0.0f;
};

/// Both arms alike: hanging, as at rest, out, up, forward, on the hips, forearms up.
[[nodiscard]] std::span<const ArmPose> usual_arms() noexcept;
/// Further ways, of one arm only: forearm forward, swung back, before the chest.
[[nodiscard]] std::span<const ArmPose> single_arms() noexcept;

/// Degrees of a left leg: thigh forward (hip flexion), knee's bend, thigh outwards.
struct LegPose {
    float forward = 0.0f, knee = 0.0f, out = 0.0f;
};
/// Of one leg: standing, a step forward, a step back, raised, seated, wide.
[[nodiscard]] std::span<const LegPose> usual_legs() noexcept;

/// Both arms alike, legs `legs` degrees farther apart than at rest; the hips at the origin.
[[nodiscard]] Pose usual_pose(const Skeleton& skeleton, const ArmPose& arm, float legs);

/// `pose` with one arm (shoulder to hand) or leg (thigh to toes) of another pose.
[[nodiscard]] Pose with_arm(const Pose& pose, bool left, const Pose& of) noexcept;
[[nodiscard]] Pose with_leg(const Pose& pose, bool left, const LegPose& leg) noexcept;

} // namespace toile::body
