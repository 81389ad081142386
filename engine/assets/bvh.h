// Biovision motion files: a joint hierarchy and one row of channel values a frame.
#pragma once

#include "core/types.h"

#include <filesystem>
#include <string>
#include <vector>

namespace toile::assets {

struct BvhJoint {
    enum class Channel {
        invalid,
        x_position,
        y_position,
        z_position,
        x_rotation,
        y_rotation,
        z_rotation
    };

    std::string name;
    int parent = -1;               ///< -1: a root
    Vec3f offset = Vec3f::Zero();  ///< from the parent, metres
    Vec3f end = Vec3f::Zero();     ///< "End Site" below it, metres; zero when there is none
    std::vector<Channel> channels; ///< in the order of the file
    std::size_t first_channel = 0; ///< column of the first of them
};

struct BvhMotion {
    std::vector<BvhJoint> joints; ///< parents before children
    std::size_t channel_count = 0;
    std::size_t frame_count = 0;
    double frame_time_s = 0.0;
    std::vector<float> values; ///< (frames x channels) metres and radians

    /// Rotation of a joint relative to its parent in one frame: the channels' axis rotations
    /// multiplied in the order of the file (the first is outermost).
    [[nodiscard]] Quatf rotation(std::size_t frame, std::size_t joint) const;
    /// Its place relative to its parent: position channels where it has them, else the offset.
    [[nodiscard]] Vec3f translation(std::size_t frame, std::size_t joint) const;
};

/// Reads a .bvh; lengths are multiplied by `metres_per_unit` (CMU motions: 0.056444), angles are
/// turned into radians. \throw FileError naming the line
[[nodiscard]] BvhMotion load_bvh(const std::filesystem::path& file, double metres_per_unit = 1.0);

} // namespace toile::assets
