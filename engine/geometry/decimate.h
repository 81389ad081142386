// Coarser versions of a surface by edge collapse (Garland and Heckbert 1997).
#pragma once

#include "geometry/mesh.h"

namespace toile::geometry {

struct Decimation {
    std::vector<std::uint32_t> vertices; ///< kept ones, by number in the full mesh, rising
    std::vector<Triangle> triangles;     ///< of places in `vertices`
};

/// Collapses edges onto one of their ends, cheapest quadric first, until at most `vertex_count`
/// vertices are left or nothing may collapse; normals never turn by more than 90 degrees. The
/// mesh must be manifold. \throw Error when it is not
[[nodiscard]] Decimation decimate(const TriangleMesh& mesh, std::size_t vertex_count);

} // namespace toile::geometry
