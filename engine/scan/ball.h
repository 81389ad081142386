// A ball in depth pictures: where its centre is.
#pragma once

#include "scan/depth_filter.h"

#include <optional>
#include <span>

namespace toile::scan {

struct BallOptions {
    double radius_m = 0.0;                             ///< 0: not known
    double least_radius_m = 0.04, most_radius_m = 0.4; ///< where it is not known
};

struct Ball {
    Vec3d centre = Vec3d::Zero(); ///< camera frame, metres
    double radius_m = 0.0;        ///< as fitted, or as it was known
    double rms_m = 0.0;           ///< of the readings, along their rays
    std::size_t readings = 0;
};

/// Least squares ball through readings (points in the camera frame), far ones counted less: errors
/// are taken along the rays, where a depth camera has them. `start` must be near it. Nothing when
/// fewer than 30 readings lie on it or it does not come to rest.
[[nodiscard]] std::optional<Ball> fit_ball(std::span<const Vec3f> points, const Ball& start,
                                           bool radius_known);

struct FoundBall {
    Ball ball;
    std::vector<Vec3f> points; ///< readings on and around it, camera frame
};

/// The roundest thing in the picture that stands apart from all else but for a stick or thread:
/// its outline is a disc, its readings a ball. Nothing when there is none.
[[nodiscard]] std::optional<FoundBall> find_ball(const imaging::Intrinsics& camera,
                                                 std::span<const float> depth,
                                                 const BallOptions& options);

} // namespace toile::scan
