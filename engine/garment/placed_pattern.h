// A sewing pattern whose panels come with stitches and a place in space, as GarmentCode writes it.
#pragma once

#include "garment/block_body.h"

#include <filesystem>

namespace toile::garment::block {

/// A whole panel, flat, and where it hangs around the body that it was designed on.
struct SpatialPanel {
    std::string name;
    std::string label;         ///< "body", "leg", "arm", or ""
    std::vector<Curve> border; ///< closed, either way round; metres, y upwards; named "0", "1", ...
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity(); ///< flat (x, y, 0) to world, metres
};

struct Stitch {
    std::size_t panel_a = 0, edge_a = 0, panel_b = 0, edge_b = 0;
};

struct SpatialPattern {
    std::vector<SpatialPanel> panels;
    std::vector<Stitch> stitches;
};

/// Reads GarmentCode's JSON (panels, edges with quadratic, cubic or circular curvature, stitches,
/// placement). Its unit is read from the file. \throw Error naming panel, edge or stitch: unknown
/// references, an edge loop that does not close, an outline that crosses itself or has no area, a
/// seam whose edges differ in length by more than half
[[nodiscard]] SpatialPattern read_garmentcode(const std::filesystem::path& file);

/// Is this a GarmentCode file? By its keys. \throw Error when it is no JSON
[[nodiscard]] bool is_garmentcode(const std::filesystem::path& file);

/// Lays the panels around a body: trunk and skirt by height and breadth, trouser legs around the
/// legs, sleeves along the arms (told by name, label and rotation), the rest as it was placed.
/// Without shoulder seams the highest free edges are held. The probe must outlive the pattern.
/// \throw Error naming what has no place
[[nodiscard]] Pattern pattern_of(const SpatialPattern& spatial, const BodyProbe& body,
                                 double clearance_m);

} // namespace toile::garment::block
