// Inner products of displacements of the symmetric template, for its principal components.
#pragma once

#include "body/avatar_template.h"

#include <Eigen/SparseCore>

namespace toile::body {

/// Over the coordinates of TargetBasis (3 half + 66; joints have no weight), areas from `positions`
/// (nv): sum over triangles of gradient_weight * area * |gradient|^2, plus sum over vertices of
/// displacement_weight * area * |displacement|^2. The first term is the squared distance of SCAPE's
/// shape matrices S, which are linear in the displacement.
[[nodiscard]] Eigen::SparseMatrix<float> shape_metric(const AvatarTemplate& avatar,
                                                      std::span<const Vec3f> positions,
                                                      double gradient_weight,
                                                      double displacement_weight);

} // namespace toile::body
