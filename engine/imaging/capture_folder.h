// Recordings as folders of pictures (Open3D's layout), one or several cameras.
//
// FOLDER/intrinsic.json    width, height, intrinsic_matrix (9, column-major), depth_scale (units a
//                          metre), optional distortion (8: k1 k2 p1 p2 k3 k4 k5 k6)
// FOLDER/extrinsic.json    optional: world_from_camera (16, column-major, looks along -Z, +Y up)
// FOLDER/timestamps.csv    optional: frame, seconds; without it 30 frames a second
// FOLDER/depth/000000.png  16 bits; 0 = unknown
// FOLDER/color/000000.jpg  or .png; optional, registered to depth
// FOLDER/mask/000000.png   optional; white where the person is
// Several cameras: such folders below a common one.
#pragma once

#include "imaging/camera.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile::imaging {

struct CaptureFrame {
    std::uint32_t number = 0; ///< as in the file names
    double time_s = 0.0;
    std::filesystem::path depth;
    std::filesystem::path color; ///< empty: none
    std::filesystem::path mask;  ///< empty: none
};

struct CaptureCamera {
    std::string name; ///< folder name among several cameras, else ""
    Intrinsics intrinsics;
    double depth_scale = 1000.0; ///< units a metre
    std::optional<Eigen::Isometry3d> world_from_camera;
    std::vector<CaptureFrame> frames; ///< rising numbers and times

    /// Pictures of one frame, of the camera's size. \throw Error
    [[nodiscard]] DepthImage load_depth(std::size_t frame) const;
    [[nodiscard]] std::optional<Image> load_color(std::size_t frame) const;
    [[nodiscard]] std::optional<Image> load_mask(std::size_t frame) const;
};

struct Capture {
    std::filesystem::path folder;
    std::vector<CaptureCamera> cameras; ///< by name
};

/// Reads everything but the pictures. \throw Error naming the file and what is wrong with it
[[nodiscard]] Capture open_capture(const std::filesystem::path& folder);

/// Writes one camera's folder frame by frame.
class CaptureWriter {
  public:
    /// Makes the folder and its json files. \throw Error, also when it already holds a capture
    CaptureWriter(std::filesystem::path folder, const Intrinsics& intrinsics,
                  const std::optional<Eigen::Isometry3d>& world_from_camera = std::nullopt,
                  double depth_scale = 1000.0);

    /// Frames are numbered from 0; times must rise. `color` and `mask` may be null. The time is
    /// written at once, so that what was recorded can be read after an interruption. \throw Error
    void add(double time_s, const DepthImage& depth, const Image* color = nullptr,
             const Image* mask = nullptr);

    [[nodiscard]] std::uint32_t frame_count() const { return count_; }

  private:
    std::filesystem::path folder_;
    Intrinsics intrinsics_;
    double depth_scale_;
    double last_time_s_ = 0.0;
    std::uint32_t count_ = 0;
};

} // namespace toile::imaging
