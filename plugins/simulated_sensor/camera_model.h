// What a simulated camera is: its picture, its range, and what is wrong with it.
#pragma once

#include "imaging/camera.h"

#include <optional>
#include <string>
#include <string_view>

namespace toile::simulated_sensor {

/// Kinect v1 finds depth by triangulation between projector and camera; v2 by time of flight.
enum class CameraModel : std::uint8_t { invalid, kinect_v1, kinect_v2 };

/// "kinect_v1". Nothing for an unknown name.
[[nodiscard]] std::optional<CameraModel> camera_model_from_name(std::string_view name);

/// Each effect has a switch; where a number stands, 0 is off.
struct NoiseSettings {
    double axial = 1.0;       ///< times sigma_z of Nguyen et al. 2012: see imaging/depth_noise.h
    double lateral = 1.0;     ///< times sigma_L of the same, likewise
    bool quantisation = true; ///< disparity in 1/8 pixel, rounded to nearest
    bool shadow = true;       ///< no reading where the projector does not reach
    bool ragged = true;       ///< readings lost at silhouettes, on grazing surfaces and in hair
    double holes = 0.0;       ///< share of the readings that is lost in patches of 4 to 20 pixels
    double color = 1.0;       ///< times the usual noise of the colour picture
    /// Systematic errors: smoothing does not take them away.
    bool correlated = false;              ///< axial noise goes together over a few pixels
    double depth_scale = 0.0;             ///< each camera's depths are off by up to this share
    double extrinsic_rotation = 0.0;      ///< sigma of the angle of the reported pose, radians
    double extrinsic_translation_m = 0.0; ///< sigma of the reported pose along each axis
};

/// Nothing wrong at all.
[[nodiscard]] NoiseSettings no_noise();
/// What such a camera does to every frame, but no systematic error.
[[nodiscard]] NoiseSettings usual_noise(CameraModel model);
/// The same and systematic errors: depth scale +-0.5 %, poses off by 0.2 degrees and 5 mm,
/// correlated noise.
[[nodiscard]] NoiseSettings full_noise(CameraModel model);

struct CameraSettings {
    std::string name;
    CameraModel model = CameraModel::kinect_v1;
    /// Mounted on its side with the projector on top; the picture is turned upright again, so that
    /// width and height change places.
    bool upright = false;
    Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity(); ///< as it really stands
    double nearest_m = 0.5;                                              ///< no readings below
    double farthest_m = 8.0;
    NoiseSettings noise;

    /// v1: 640 x 480 pixels, 57 x 43 degrees. v2: 512 x 424 pixels, 70.6 x 60 degrees.
    [[nodiscard]] imaging::Intrinsics intrinsics() const;
    /// Pixels of focal length along the line from the camera to its projector.
    [[nodiscard]] double baseline_focal() const;
};

/// Range and usual noise of a model.
[[nodiscard]] CameraSettings camera_of(CameraModel model);

/// A camera at `position` that looks at `target`, +Y up, turned by `roll` about its view.
/// \throw Error when the two are one, or above each other
[[nodiscard]] Eigen::Isometry3d look_at(const Vec3d& position, const Vec3d& target,
                                        double roll = 0.0);

} // namespace toile::simulated_sensor
