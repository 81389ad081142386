// Other systems' skeletons in terms of our 22 joints.
#pragma once

#include "body/skeleton.h"

#include <span>
#include <string>
#include <vector>

namespace toile::body {

/// Where one of our joints lies in a foreign skeleton: at `first`, or on the way from `first` to
/// `second` (positions: linear; rotations: along the arc).
struct JointBlend {
    std::uint8_t first = 0;  ///< index into SkeletonTable::joints
    std::uint8_t second = 0; ///< equal to `first` where the joint maps directly
    float fraction = 0.0f;   ///< 0: at first, 1: at second

    [[nodiscard]] bool direct() const { return first == second; }
};

/// Every one of our joints has a source. Rotations of joints between two others are interpolated.
struct SkeletonTable {
    std::string_view name;                       ///< "kinect_v2"
    std::span<const std::string_view> joints;    ///< foreign names in their own order
    std::array<JointBlend, kJointCount> sources; ///< by Joint

    /// Index of a foreign name, or nothing.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view joint) const;
};

/// SDK 1: 20 joints, HipCenter first.
[[nodiscard]] const SkeletonTable& kinect_v1_table();
/// SDK 2: 25 joints, SpineBase first; its first 20 stand where those of SDK 1 stand.
[[nodiscard]] const SkeletonTable& kinect_v2_table();
/// Azure Kinect Body Tracking: 32 joints, PELVIS first.
[[nodiscard]] const SkeletonTable& azure_kinect_table();
/// Names without their "mixamorig:" prefix.
[[nodiscard]] const SkeletonTable& mixamo_table();

/// The table whose joint names all occur among `names` (as found in a BVH, glTF or FBX file;
/// a prefix up to ':' is ignored): Mixamo, the two namings of CMU's motions, or MotionBuilder-like.
[[nodiscard]] const SkeletonTable* find_table(std::span<const std::string> names);

/// "mixamorig:Hips" -> "Hips".
[[nodiscard]] std::string_view without_prefix(std::string_view name);

/// All tables, for tests and listings.
[[nodiscard]] std::vector<const SkeletonTable*> all_tables();

} // namespace toile::body
