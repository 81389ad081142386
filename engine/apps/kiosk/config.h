// What an operator sets: the file of `toile kiosk --config` (docs/kiosk.md,
// docs/schemas/kiosk.schema.json).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile::apps::kiosk {

struct MirrorSettings {
    double scale = 1.0;    ///< 1 and more: the picture enlarged about its middle
    double offset_x = 0.0; ///< shares of the picture that its middle is moved by; right
    double offset_y = 0.0; ///< down
};

/// Where the camera stands, for sensors that do not know it.
struct CameraSettings {
    double height_m = 1.2; ///< of the lens above the floor
    double tilt_deg = 0.0; ///< up is positive
};

struct KioskConfig {
    std::string source;                ///< source URI; empty: must be named on the command line
    std::vector<std::string> garments; ///< ids, folders or zips; empty: all of `garments_folder`
    std::filesystem::path garments_folder; ///< watched for changes; empty: the shipped garments
    std::string language = "en";           ///< name of a file of the texts folder
    int width = 1080;                      ///< of the screen that is drawn, pixels
    int height = 1920;
    bool fullscreen = true;
    bool hide_cursor = true;
    std::uint32_t people = 2; ///< at once, each with a garment of their own; 1 or 2
    bool measure = true;      ///< ask for a turn and choose sizes by it
    double dwell_s = 1.2;     ///< how long a hand rests on a button
    double away_s = 3.0;      ///< nobody seen for so long: everything of them is erased
    double patience_s = 60.0; ///< a question that nobody answers for so long counts as no
    MirrorSettings mirror;
    CameraSettings camera;
    std::filesystem::path metrics;   ///< Prometheus text file; empty: none
    std::filesystem::path snapshots; ///< folder; empty: no snapshots, no button for them
    bool watchdog = true;            ///< a parent process starts the mirror again
    double stall_s = 1.5;            ///< no sign of life for so long: it is started again
    double operator_line_s = 20.0;   ///< how long a note stands at the screen's foot
};

/// Relative paths start at the file's folder.
/// \throw Error naming file and place: an unknown key, a wrong type, a number out of range
[[nodiscard]] KioskConfig load_config(const std::filesystem::path& file);

/// Changes mirror and camera in a configuration file; the other keys stay as they are. Written
/// beside it first, so that a full disk leaves the old one. \throw Error
void save_setup(const std::filesystem::path& file, const MirrorSettings& mirror,
                const CameraSettings& camera);

} // namespace toile::apps::kiosk
