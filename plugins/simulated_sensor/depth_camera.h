// One simulated depth camera: from what its rays meet to what it reports.
#pragma once

#include "core/row_loop.h"
#include "simulated_sensor/camera_model.h"
#include "simulated_sensor/pixel_random.h"
#include "simulated_sensor/stage.h"

namespace toile::simulated_sensor {

/// What one camera has wrong for a whole recording.
struct SystematicErrors {
    double depth_scale = 1.0;                                     ///< factor on its depths
    Eigen::Isometry3d pose_error = Eigen::Isometry3d::Identity(); ///< in the camera's frame
};
/// Drawn from the seed: depth scale uniform, axis of the turn uniform on the sphere, its angle and
/// the shift along each axis normal.
[[nodiscard]] SystematicErrors draw_errors(const NoiseSettings& noise, std::uint64_t seed,
                                           std::uint32_t camera);

/// Buffers are taken once; `look` and `measure` allocate nothing. The results depend on the scene,
/// the seed, the camera's number and the frame's, and on nothing else.
class DepthCamera {
  public:
    DepthCamera(const CameraSettings& settings, std::uint64_t seed, std::uint32_t number);

    /// Casts a ray through every pixel.
    void look(const Stage& stage, const RowLoop& rows);
    /// Turns what was seen last into the depth picture of one frame, noise and all. Whole
    /// millimetres, as the device gives them, when `round_to_mm`.
    void measure(const Stage& stage, std::uint32_t frame, const RowLoop& rows,
                 bool round_to_mm = true);

    [[nodiscard]] const CameraSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] const imaging::Intrinsics& intrinsics() const noexcept { return intrinsics_; }
    [[nodiscard]] const SystematicErrors& errors() const noexcept { return errors_; }
    /// Where the camera says that it stands.
    [[nodiscard]] Eigen::Isometry3d reported_pose() const {
        return settings_.world_from_camera * errors_.pose_error;
    }
    /// What the rays met, without any error.
    [[nodiscard]] const HitMap& hits() const noexcept { return hits_; }
    /// Directions of the rays, world frame, length 1 along the axis. (width * height)
    [[nodiscard]] std::span<const Vec3f> directions() const noexcept { return directions_; }
    [[nodiscard]] Vec3f origin() const {
        return settings_.world_from_camera.translation().cast<float>();
    }
    [[nodiscard]] const imaging::DepthImage& depth() const noexcept { return depth_; }

  private:
    void find_silhouettes(const RowLoop& rows);
    void cast_shadow(const RowLoop& rows);
    void shift_silhouettes(const Stage& stage, const PixelRandom& random, const RowLoop& rows);
    void fill_noise(const PixelRandom& random, const RowLoop& rows);
    [[nodiscard]] bool lost(const Stage& stage, const PixelRandom& random, int x, int y) const;
    [[nodiscard]] float nearest_tilt(int x, int y) const;
    [[nodiscard]] bool crosses(std::size_t i, const Eigen::Vector2d& place) const;
    [[nodiscard]] std::size_t at(int x, int y) const noexcept {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(intrinsics_.width) +
               static_cast<std::size_t>(x);
    }

    CameraSettings settings_;
    imaging::Intrinsics intrinsics_;
    std::uint64_t seed_;
    std::uint32_t number_;
    SystematicErrors errors_;
    std::vector<Vec3f> directions_;

    HitMap hits_;
    std::vector<std::uint8_t> near_silhouette_; // (pixels) within reach of a jump in depth
    std::vector<std::uint8_t> reach_;           // (pixels) the same along rows only
    std::vector<std::uint8_t> shadowed_;        // (pixels)
    std::vector<Hit> seen_;                     // (pixels) after the silhouettes were shifted
    std::vector<std::uint8_t> dark_;            // (pixels) shadowed, then
    std::vector<float> noise_;                  // (pixels) standard normal
    std::vector<float> white_;                  // (padded) the same before it is filtered
    std::vector<float> nearest_;                // (lines x bins) what the projector meets
    imaging::DepthImage depth_;
};

} // namespace toile::simulated_sensor
