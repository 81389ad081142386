// The readers behind load_motion, one per format.
#pragma once

#include "body/motion.h"

namespace toile::body {

/// Rotations relative to the file's own rest pose, whose bone directions are aligned with ours;
/// root motion scaled by leg length (so that the file's unit does not matter), begun at x = z = 0
/// facing +Z; floor where the lowest foot is in 5 % of the frames. \throw Error
[[nodiscard]] Motion read_bvh_motion(const std::filesystem::path& file, const Skeleton& skeleton);

/// `{"schema": 1, ...}`: see docs/schemas/motion.schema.json. \throw JsonError
[[nodiscard]] Motion read_keyframes(const std::filesystem::path& file, const Skeleton& skeleton);

/// track.jsonl. \throw JsonError naming the line
[[nodiscard]] Motion read_track(const std::filesystem::path& file, const Skeleton& skeleton);

} // namespace toile::body
