// Recorded and keyframed motion of one body, and single poses: reading and sampling.
#pragma once

#include "body/body_volumes.h"
#include "body/skeleton.h"

#include <filesystem>
#include <string>
#include <vector>

namespace toile::body {

/// Poses over time, already fitted to one skeleton.
struct Motion {
    std::string name;
    std::vector<double> times; ///< seconds, rising, the first is 0
    std::vector<Pose> poses;   ///< (times)

    [[nodiscard]] double duration() const { return times.empty() ? 0.0 : times.back(); }
};

/// Pose at a time, held before the first and after the last; rotations along the shortest arc.
[[nodiscard]] Pose sample(const Motion& motion, double time_s);

/// Reads by extension and fits to the body: `.bvh` (see retarget_bvh), `.jsonl` (a track; the
/// person of the first line that has one; frames without them hold the last pose) and `.json` (our
/// keyframes, docs/file_formats.md). With `volumes`, arms are eased out of the body.
/// \throw Error naming the file, the line or place in it, and what is wrong
[[nodiscard]] Motion load_motion(const std::filesystem::path& file, const Skeleton& skeleton,
                                 const BodyVolumes* volumes = nullptr);

/// The first pose of a motion file. \throw Error as load_motion
[[nodiscard]] Pose load_pose(const std::filesystem::path& file, const Skeleton& skeleton,
                             const BodyVolumes* volumes = nullptr);

/// World rotations and the hips' place as a pose.
[[nodiscard]] Pose pose_from_world(const JointTransforms& world);

/// Height of the lowest point of both soles (heel and toes); 0 when standing at rest.
[[nodiscard]] float lowest_sole(const Skeleton& skeleton, const JointTransforms& world);

/// Turns from a body's rest into a foreign rest pose: rotation of each joint, in the world, that
/// takes its bone to `directions[joint]`; zero directions and joints without a bone stay.
/// directions (22), unit or zero.
[[nodiscard]] std::array<Quatf, kJointCount>
rest_alignment(const Skeleton& skeleton, const std::array<Vec3f, kJointCount>& directions);

} // namespace toile::body
