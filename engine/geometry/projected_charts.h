// A texture atlas for any surface: charts that are the surface as seen along the axes.
#pragma once

#include "geometry/atlas.h"

namespace toile::geometry {

struct ProjectedAtlas {
    SeamedLayout layout;
    std::vector<int> charts; ///< (nf) chart of each triangle
    int chart_count = 0;
    float side = 0.0f; ///< what the whole texture spans, in the units of the positions
};

/// Charts of a surface that need be no discs: each triangle is seen along the axis that it faces
/// most, pieces of one axis are grown from triangle to triangle as long as none lies on another,
/// and crumbs join the piece beside them. Every triangle keeps at least a quarter of its area.
/// Triangles without area keep none. Boxes are packed by `pack_boxes`.
/// \throw Error when nothing has an area, or the pieces do not fit
[[nodiscard]] ProjectedAtlas make_projected_atlas(std::span<const Vec3f> positions,
                                                  std::span<const Triangle> triangles,
                                                  const AtlasOptions& options = {});

} // namespace toile::geometry
