// The Kinect body log: one line a frame, read strictly.
#pragma once

#include "core/types.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace toile::kinect_log_source {

/// A joint as the sensor gave it: metres, camera frame of the Kinect (x to the person's right when
/// facing the sensor, y up, z away from the sensor).
struct LoggedJoint {
    Vec3f position = Vec3f::Zero();
    std::uint8_t state = 0; ///< 0 not tracked, 1 inferred, 2 tracked
};

struct LoggedFrame {
    std::int64_t time_100ns = 0;
    std::array<LoggedJoint, 25> joints; ///< in Kinect v2 order; the last five unset for 20 joints
};

struct KinectLog {
    std::size_t joint_count = 0; ///< 20 or 25
    std::vector<LoggedFrame> frames;
};

/// `text`: per line the time in 100 ns units, then x, y, z, state per joint, separated by commas;
/// one comma may end the line. Times rise strictly. `name` stands for the file in errors.
/// \throw FileError naming the line: blank, wrong number of fields, not a number, not finite,
/// farther than 50 m, state not 0, 1, 2, time not rising, or no line at all
[[nodiscard]] KinectLog parse_kinect_log(std::string_view text, const std::string& name);

/// Reads a file of at most 512 MB. \throw FileError
[[nodiscard]] KinectLog load_kinect_log(const std::filesystem::path& file);

} // namespace toile::kinect_log_source
