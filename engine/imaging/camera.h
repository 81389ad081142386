// Cameras: pixels to rays and back.
//
// Camera frame as in glTF: looks along its -Z, +Y up, metres. Pixels: (0, 0) is the centre of the
// top-left one, x to the right, y down. Depth is measured along the axis (-Z), not along the ray.
#pragma once

#include "core/types.h"
#include "imaging/image.h"

#include <optional>
#include <span>
#include <vector>

namespace toile::imaging {

/// Pinhole with Brown-Conrady distortion, pixels; as toile_intrinsics and OpenCV's camera matrix.
struct Intrinsics {
    int width = 0;
    int height = 0;
    double fx = 0.0;
    double fy = 0.0;
    double cx = 0.0;
    double cy = 0.0;
    std::array<double, 8> distortion{}; ///< k1 k2 p1 p2 k3 k4 k5 k6

    [[nodiscard]] bool distorted() const;
    /// Horizontal and vertical field of view, radians, distortion left out.
    [[nodiscard]] Eigen::Vector2d field_of_view() const;
};

/// Pixel of a point in the camera frame; nothing when it is not in front of the camera.
[[nodiscard]] std::optional<Eigen::Vector2d> project(const Intrinsics& camera, const Vec3d& point);

/// Point at `depth` metres under a pixel; nothing where the distortion cannot be undone (Newton's
/// method does not converge).
[[nodiscard]] std::optional<Vec3d> unproject(const Intrinsics& camera, const Eigen::Vector2d& pixel,
                                             double depth);

/// Turns depth pictures of one camera into points; the rays are worked out once.
class DepthUnprojector {
  public:
    /// \throw Error when the intrinsics make no sense
    explicit DepthUnprojector(const Intrinsics& camera);

    /// `depth` (width * height) metres -> `points` (width * height) in the camera frame, NaN where
    /// the depth is unknown.
    void points(std::span<const float> depth, std::span<Vec3f> points) const noexcept;

    [[nodiscard]] const Intrinsics& camera() const { return camera_; }

  private:
    Intrinsics camera_;
    std::vector<Vec3f> rays_; // (width * height) points at depth 1
};

/// The colour picture as the depth camera would see it: each depth pixel takes the colour of the
/// place it shows (bilinear); alpha 0 where the depth is unknown or the place is out of the colour
/// camera's sight. \throw Error when picture sizes and intrinsics differ
[[nodiscard]] Image register_color(const DepthImage& depth, const Intrinsics& depth_camera,
                                   const Image& color, const Intrinsics& color_camera,
                                   const Eigen::Isometry3d& color_from_depth);

/// \throw Error naming what is wrong: sizes and focal lengths must be positive, all finite
void check_intrinsics(const Intrinsics& camera);

} // namespace toile::imaging
