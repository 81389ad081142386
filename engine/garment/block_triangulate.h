// Near-uniform triangles inside a closed outline, with the outline's own points on the border.
#pragma once

#include "garment/block_pattern.h"

namespace toile::garment::block {

/// A flat piece: the outline's points first, in order, then the inner ones.
struct FlatMesh {
    std::vector<Vec2d> points;       ///< (nv) metres
    std::vector<Triangle> triangles; ///< (nf) counter-clockwise
    std::size_t border_count = 0;    ///< the first points are the outline
};

/// Fills a counter-clockwise outline whose edges are about `edge_m` long (Delaunay of a smoothed
/// hexagonal lattice). Deterministic. \throw Error when the outline cannot be kept
[[nodiscard]] FlatMesh triangulate(std::span<const Vec2d> outline, double edge_m);

/// Values on the inner points that are harmonic on the mesh (cotangent weights) and equal
/// `border` (border_count x 3) on the outline: linear fields come back exactly.
[[nodiscard]] std::vector<Vec3d> harmonic(const FlatMesh& mesh, std::span<const Vec3d> border);

} // namespace toile::garment::block
