// Poses for training frames: recorded ones, people who stand about, and anything joints allow.
#pragma once

#include "body/skeleton.h"
#include "core/random.h"

#include <filesystem>
#include <span>
#include <vector>

namespace toile::body_tracker {

/// Poses of the motion files (`.bvh`, `.jsonl`, `.json`), ten a second, fitted to one body; turned
/// to face +Z. A folder stands for all files of those kinds in it, sorted. \throw Error naming a
/// file that cannot be read, or a path with nothing to read
[[nodiscard]] std::vector<body::Pose> read_poses(std::span<const std::filesystem::path> paths,
                                                 const body::Skeleton& skeleton);

/// Every joint but the hips turned about a random axis: normal, `sigma_rad` along each axis.
[[nodiscard]] body::Pose perturbed(const body::Pose& pose, double sigma_rad, Random& random);

/// Stands, each arm where people hold them: hanging, out, up, forward, on the hip, crossed in
/// front, forearm raised, at the head, behind the back; often both alike. Faces +Z.
[[nodiscard]] body::Pose standing_pose(const body::Skeleton& skeleton, Random& random);

/// Of the recorded poses, mirrored half the time and perturbed by 5 to 15 degrees (40 %), standing
/// (40 %), or anywhere within the joints' limits (20 %); without recorded ones standing and
/// anywhere have equal shares. Faces +Z.
[[nodiscard]] body::Pose draw_pose(const body::Skeleton& skeleton,
                                   std::span<const body::Pose> recorded, Random& random);

} // namespace toile::body_tracker
