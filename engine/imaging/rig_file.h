// Where the cameras of a rig stand: what `toile scan --calibrate` writes (docs/file_formats.md).
#pragma once

#include "core/json.h"
#include "core/types.h"

#include <filesystem>
#include <string>
#include <vector>

namespace toile::imaging {

struct RigCamera {
    std::string name; ///< of its stream
    Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
};

struct RigFile {
    std::string method;             ///< "ball", "person", "board"
    std::vector<RigCamera> cameras; ///< in the order of the sources
    nlohmann::ordered_json report;  ///< how the calibration went, an object
};

/// Sixteen numbers, column-major. \throw JsonError when they are no rigid motion
[[nodiscard]] Eigen::Isometry3d read_rigid_motion(JsonObject& object, const std::string& key);

/// \throw JsonError, FileError
[[nodiscard]] RigFile load_rig(const std::filesystem::path& file);
void save_rig(const RigFile& rig, const std::filesystem::path& file);

} // namespace toile::imaging
