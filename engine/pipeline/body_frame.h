// One person's joints in one frame, and motion between two of them.
#pragma once

#include "abi/body.h"
#include "body/skeleton.h"

#include <array>
#include <cstdint>

namespace toile::pipeline {

using JointArray = std::array<toile_joint, body::kJointCount>;

/// What a source says of one person in one frame; world coordinates.
struct BodyFrame {
    std::uint32_t person_id = 1;
    std::uint32_t tracking = TOILE_TRACKING_TRACKED;
    std::uint32_t sequence = 0;
    std::int64_t timestamp_ns = 0;
    JointArray joints{};
};

/// Are all joints finite, and their rotations unit quaternions?
[[nodiscard]] bool plausible(const JointArray& joints) noexcept;
[[nodiscard]] body::JointTransforms transforms_of(const JointArray& joints) noexcept;
/// Velocities are zero.
[[nodiscard]] JointArray joints_of(const body::JointTransforms& world, float confidence) noexcept;
[[nodiscard]] JointArray rest_joints(const body::Skeleton& skeleton) noexcept;

/// Rotations relative to the parents, and the hips' place.
[[nodiscard]] body::Pose local_pose(const body::JointTransforms& world) noexcept;

/// Each joint turns along the shortest way, so that bones keep their length; share in [0, 1].
[[nodiscard]] body::Pose interpolate(const body::Pose& from, const body::Pose& to,
                                     float share) noexcept;

} // namespace toile::pipeline
