// track.jsonl: one line a frame, people and their joints in the world.
#pragma once

#include "body/skeleton.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace toile::body {

enum class TrackState : std::uint8_t { invalid, detected, tracked, uncertain, lost };

/// "tracked"; "" for invalid.
[[nodiscard]] std::string_view track_state_name(TrackState state);

struct TrackedPerson {
    std::uint32_t id = 0;
    TrackState state = TrackState::invalid;
    JointTransforms joints; ///< world_from_joint
    std::array<float, kJointCount> confidence{};
};

/// One line with its line end. Positions and rotations have six decimals, so that the same values
/// give the same bytes everywhere. \throw Error for a value that is not finite
[[nodiscard]] std::string track_line(std::uint64_t frame, double time_s,
                                     std::span<const TrackedPerson> people);

/// One line of a track.
struct TrackFrame {
    std::uint64_t frame = 0;
    double time_s = 0.0;
    std::vector<TrackedPerson> people;
};

/// A whole track as it stands in the file; joints that are missing go with their parents.
/// \throw FileError naming the line
[[nodiscard]] std::vector<TrackFrame> read_track_frames(const std::filesystem::path& file);

} // namespace toile::body
