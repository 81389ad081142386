// The body parts that the forest tells apart, and what each says about joints and P4's parts.
#pragma once

#include "body/body_model.h"

#include <span>
#include <vector>

namespace toile::body_tracker {

/// Left and right are the person's own.
enum class PartLabel : std::uint8_t {
    invalid,
    head,
    neck,
    left_chest,
    right_chest,
    left_belly,
    right_belly,
    left_pelvis,
    right_pelvis,
    left_shoulder,
    right_shoulder,
    left_upper_arm,
    right_upper_arm,
    left_lower_arm,
    right_lower_arm,
    left_hand,
    right_hand,
    left_thigh,
    right_thigh,
    left_shin,
    right_shin,
    left_foot,
    right_foot,
};
inline constexpr int kPartCount = 22; ///< without `invalid`

/// P4's part that holds it; invalid for invalid.
[[nodiscard]] body::Part p4_part(PartLabel label) noexcept;
/// The joint that its pixels stand for; hips for invalid.
[[nodiscard]] body::Joint part_joint(PartLabel label) noexcept;
/// The same part of the other side; head and neck themselves.
[[nodiscard]] PartLabel opposite_part(PartLabel label) noexcept;

/// Label of each vertex (nv): its heaviest joint decides, on the trunk with the side of x = 0 at
/// rest.
[[nodiscard]] std::vector<PartLabel> label_vertices(const body::SkinWeights& skin,
                                                    std::span<const Vec3f> rest);
[[nodiscard]] std::vector<PartLabel> label_vertices(const body::BodyModel& model);

} // namespace toile::body_tracker
