// Fields over a garment's surface that follow known values where these are trusted and are smooth
// everywhere.
#pragma once

#include "core/types.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

namespace toile::mesh_garment {

/// Positive semi-definite Laplacian with cotangent weights kept positive, and vertex areas.
struct SurfaceOperator {
    Eigen::SparseMatrix<double> laplacian; ///< (nv x nv)
    Eigen::VectorXd areas;                 ///< (nv) m^2, positive
};
[[nodiscard]] SurfaceOperator surface_operator(std::span<const Vec3f> positions,
                                               std::span<const Triangle> triangles);

/// The field u (nv x k) that minimises
///     sum_v area_v trust_v |u_v - values_v|^2 + length^4 |L u|^2 (in the metric of the areas):
/// where trust is 1, details larger than `length` metres stay; where it is small the field is
/// filled in smoothly from around. `trust` (nv) must be positive. \throw Error when the system
/// cannot be factored
[[nodiscard]] Eigen::MatrixXd fill_smoothly(const SurfaceOperator& surface,
                                            const Eigen::MatrixXd& values,
                                            const Eigen::VectorXd& trust, double length);

} // namespace toile::mesh_garment
