// Makes an artist's mesh fit to be simulated: welded, consistently oriented, manifold.
#pragma once

#include "core/types.h"
#include "geometry/mesh.h"

#include <span>
#include <vector>

namespace toile::garment {

struct MendedMesh {
    geometry::TriangleMesh mesh;       ///< manifold; vertices pairwise at different places
    std::vector<Triangle> corners;     ///< (nf) input vertices that the corners come from
    std::size_t merged_vertices = 0;   ///< that stood within `weld_distance` of another
    std::size_t dropped_triangles = 0; ///< without area, or standing twice
    std::size_t turned_triangles = 0;  ///< to agree with their neighbours
    std::size_t cut_edges = 0;         ///< with more than two triangles, cut open
};

/// Welds vertices within `weld_distance` metres, drops triangles without area, turns triangles to
/// agree with the majority of their piece, and cuts the surface open along edges with more than two
/// triangles. Copies of a vertex made by cutting stand a few micrometres apart, so that welding
/// equal positions does not undo it. Deterministic.
[[nodiscard]] MendedMesh mend(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                              double weld_distance = 2e-5);

} // namespace toile::garment
