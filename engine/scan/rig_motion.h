// Where cameras stand to each other, from places that several of them saw at one time: centres of
// a moved ball, corners of a board.
#pragma once

#include "scan/volume.h"

#include <optional>
#include <span>
#include <string>

namespace toile::scan {

/// A place as one camera saw it, camera frame.
struct SeenPlace {
    Vec3d point = Vec3d::Zero();
    double along_m = 0.002;  ///< deviation along the ray
    double across_m = 0.001; ///< and across it
};

/// (cameras) x (places): nothing where the camera did not see it.
using SeenPlaces = std::vector<std::vector<std::optional<SeenPlace>>>;

struct RigidFit {
    Pose a_from_b = Pose::Identity();
    std::vector<std::uint32_t> inliers; ///< of the pairs
    double rms_m = 0.0;                 ///< of those
    double spread_m = 0.0; ///< rms of the inliers off the line that is nearest to all of them
};

/// Least squares rotation and translation with a = R b + t (Horn 1987; P1 eq. 7 with the norm's
/// square).
[[nodiscard]] Pose rigid_motion(std::span<const Vec3d> a, std::span<const Vec3d> b);

/// The same over most of the pairs: of `draws` samples of `sample` pairs (P1 2.2: 4) the motion
/// that most pairs agree with within `reach_m`, then least squares over those. Deterministic.
[[nodiscard]] RigidFit robust_motion(std::span<const Vec3d> a, std::span<const Vec3d> b,
                                     double reach_m, int draws = 500, std::size_t sample = 3);

struct SolvedRig {
    std::vector<Pose> first_from_camera;
    std::vector<std::size_t> places; ///< (cameras) that were used
    std::vector<double> rms_m;       ///< (cameras) of those, from where all cameras have them
};

/// Pairs of cameras are placed by what both saw, chained from the first camera by the best pairs,
/// then all places and cameras adjusted at once, weighted by their deviations; wrong places are
/// left out. `names` of the cameras are for errors.
/// \throw Error when a camera saw too few places, never one that a placed camera saw too, or all on
/// one line
[[nodiscard]] SolvedRig solve_rig(const SeenPlaces& seen, std::span<const std::string> names);

} // namespace toile::scan
