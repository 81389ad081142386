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

/// Shares of the kinds of poses; what is left is anywhere within the joints' limits.
struct PoseMix {
    double recorded = 0.4;
    double standing = 0.4;
    double turned = 1.0; ///< recorded ones are perturbed by 5 to 15 degrees times this
};

/// A pose of the mix, recorded ones mirrored half the time; without recorded ones standing and
/// anywhere have equal shares. Faces +Z.
[[nodiscard]] body::Pose draw_pose(const body::Skeleton& skeleton,
                                   std::span<const body::Pose> recorded, const PoseMix& mix,
                                   Random& random);

} // namespace toile::body_tracker
