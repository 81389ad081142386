// What may be wrong with a camera: where it stands, how it is turned, and the length of its depths.
#pragma once

#include "core/types.h"

namespace toile::scape_fit {

/// p -> place + shift + exp(turn) scale (p - place), all about the camera's reported place.
struct CameraCorrection {
    Vec3d turn = Vec3d::Zero();  ///< rotation vector, radians
    Vec3d shift = Vec3d::Zero(); ///< metres
    double scale = 1.0;

    /// World points as the reported camera has them, and as they are.
    [[nodiscard]] Vec3f apply(const Vec3f& point, const Vec3f& place) const;
    [[nodiscard]] Vec3f undo(const Vec3f& point, const Vec3f& place) const;
};

/// Rotation of a rotation vector.
[[nodiscard]] Eigen::Matrix3d rotation_of(const Vec3d& turn);

} // namespace toile::scape_fit
