// The cotangent Laplacian and the mass matrix of a triangle mesh.
#pragma once

#include "core/types.h"

#include <Eigen/SparseCore>
#include <span>

namespace toile::geometry {

/// (nv x nv), symmetric, positive semi-definite (our sign): L_ij = -(cot a + cot b) / 2 for the
/// angles a and b that face edge ij, L_ii = minus the rest of the row. Constants are in its null
/// space. Edges that face more than 180 degrees of angle together get a positive L_ij (P3 and
/// others clamp these; then linear functions are no longer harmonic, so they are kept here: the
/// energy x'Lx = integral of |grad x|^2 stays non-negative in any case). The guard is against
/// slivers: a triangle's doubled area counts as at least 1e-8 of its longest side squared, which
/// bounds the cotangents and keeps the sign.
/// \throw Error for an index out of range
[[nodiscard]] Eigen::SparseMatrix<double> cotangent_laplacian(std::span<const Vec3f> positions,
                                                              std::span<const Triangle> triangles);

enum class MassKind {
    invalid,
    barycentric, ///< a third of the area of each triangle at the vertex
    voronoi,     ///< Voronoi cells; in obtuse triangles Meyer et al. 2003's mixed areas
};

/// (nv) area that belongs to each vertex, m^2; the sum is the mesh's area.
/// \throw Error for an index out of range
[[nodiscard]] Eigen::VectorXd lumped_mass(std::span<const Vec3f> positions,
                                          std::span<const Triangle> triangles,
                                          MassKind kind = MassKind::voronoi);

} // namespace toile::geometry
