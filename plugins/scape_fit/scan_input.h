// A scan as it comes: unit, way up and what is the person in it are guessed, and said.
#pragma once

#include "scape_fit/person_finder.h"

namespace toile::scape_fit {

struct PreparedScan {
    Observation observation; ///< of the person alone, metres, the scan's own axes
    std::vector<Vec3f> ups;  ///< directions that may be up
    std::optional<geometry::Plane> floor;
    std::string unit; ///< "m", "cm", "mm", "dm", "inch", "foot"
    double metres_per_unit = 1.0;
    bool turned_inside_out = false; ///< triangles faced inwards (a mirrored scan, for example)
    double removed_share = 0.0;     ///< of the points: floor and clutter
    geometry::TriangleMesh person;  ///< the person's part, metres; without triangles for a cloud
    std::string trouble;            ///< why it cannot be used; empty when it can
};

/// `normals` are used for clouds only; either may be empty. Points that are not finite are left
/// out. At most `count` points are kept for fitting.
[[nodiscard]] PreparedScan prepare_scan(const geometry::TriangleMesh& scan, std::size_t count);

} // namespace toile::scape_fit
