// Catmull-Clark subdivision as a matrix, so that whatever lives on the vertices can follow.
#pragma once

#include "geometry/mesh.h"

#include <Eigen/SparseCore>

namespace toile::geometry {

struct Subdivision {
    Eigen::SparseMatrix<float, Eigen::RowMajor> weights; ///< (refined x coarse), rows sum to 1
    std::vector<Triangle> triangles;                     ///< of the refined surface
};

/// One step on a quad mesh of `vertex_count` vertices; border edges and vertices stay in place.
/// Refined vertices: those of the quads' corners (unused ones too), then edges, then faces.
[[nodiscard]] Subdivision catmull_clark(std::size_t vertex_count,
                                        std::span<const std::array<std::uint32_t, 4>> quads);

/// weights * positions.
[[nodiscard]] std::vector<Vec3f> refine(const Subdivision& subdivision,
                                        std::span<const Vec3f> positions);

} // namespace toile::geometry
