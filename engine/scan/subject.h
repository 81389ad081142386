// What of a depth picture is the person or thing to be scanned: floor, walls and clutter apart.
#pragma once

#include "geometry/slice.h"
#include "scan/depth_filter.h"

#include <optional>
#include <string>

namespace toile::scan {

struct Subject {
    std::vector<std::uint8_t> mask;       ///< (pixels) 1 for the subject
    std::size_t count = 0;                ///< of those
    std::optional<geometry::Plane> floor; ///< in the camera frame, its normal up
    std::string trouble;                  ///< why nothing was found; empty when something was
};

/// The floor is found as the plane beneath nearly all else and taken away with what is within
/// 3 cm of it; the rest falls apart where depth jumps, and the largest piece that is 0.2 to 2.5 m
/// large is the subject, with pieces beside it. A podium of up to 35 cm beneath it goes too, and
/// its top is the floor then. `up`: in the camera frame, unit, within half a radian.
[[nodiscard]] Subject find_subject(const Picture& picture, const Vec3f& up);

/// A plane in other coordinates: `motion` leads there.
[[nodiscard]] inline geometry::Plane moved(const Eigen::Isometry3d& motion,
                                           const geometry::Plane& plane) {
    const Eigen::Isometry3f move = motion.cast<float>();
    return geometry::Plane::through(move * Vec3f(plane.offset * plane.normal),
                                    move.linear() * plane.normal);
}

} // namespace toile::scan
