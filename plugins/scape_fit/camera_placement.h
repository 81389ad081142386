// Where cameras stand that do not know it, found from the person whom all of them see: at each
// instant it is the same body in the same pose.
#pragma once

#include "scape_fit/fitter.h"

#include <string>

namespace toile::scape_fit {

/// One camera that feeds frames.
struct FitCamera {
    imaging::Intrinsics intrinsics;
    std::optional<Eigen::Isometry3d> world_from_camera;
};

struct PlacedCamera {
    Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
    double alone_m = 0.0;    ///< mean distance of its points from the body fitted to it alone,
    double together_m = 0.0; ///< and from the one body fitted to all; far ones counted as 10 cm
};

struct Placement {
    std::vector<PlacedCamera> cameras;
    std::string trouble; ///< why they cannot be placed; empty when they are
};

struct PlacementOptions {
    std::optional<body::Sex> sex;
    /// As FitOptions'.
    std::function<bool(double)> progress = [](double) { return false; };
};

/// Places the cameras that do not know where they stand into the world of those that do, else into
/// that of the first: upright, floor at y = 0 when it sees its floor, the camera above the origin.
/// `instants`: pictures of all cameras each. \throw Cancelled
[[nodiscard]] Placement place_cameras(const FitModel& model, Fitter& fitter,
                                      std::span<const FitCamera> cameras,
                                      std::span<const std::vector<imaging::DepthImage>> instants,
                                      const PlacementOptions& options, const RowLoop& rows);

} // namespace toile::scape_fit
