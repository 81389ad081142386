// A texture atlas: flattened charts packed into the unit square.
#pragma once

#include "geometry/mesh.h"

namespace toile::geometry {

struct AtlasOptions {
    int texels = 2048; ///< side of the texture the gaps are meant for
    int gap = 8;       ///< least texels between charts and to the border
};

/// Cuts the mesh between charts, flattens each, and packs them at one scale. `charts` (nf): chart
/// of each triangle; every chart must be a disc. Vertices of the layout stand chart by chart.
/// \throw Error naming a chart that cannot be flattened
[[nodiscard]] SeamedLayout make_atlas(std::span<const Vec3f> positions,
                                      std::span<const Triangle> triangles,
                                      std::span<const int> charts,
                                      const AtlasOptions& options = {});

} // namespace toile::geometry
