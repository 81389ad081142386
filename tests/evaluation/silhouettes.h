// Outlines of surfaces from around, for comparing shapes as they are seen.
#pragma once

#include "geometry/mesh.h"

namespace toile::evaluation {

/// Share of the pixels that either covers which both cover, the mean over `views` directions about
/// the vertical, without perspective; pixels of `pixel` metres.
[[nodiscard]] double silhouette_overlap(const geometry::TriangleMesh& a,
                                        const geometry::TriangleMesh& b, int views = 8,
                                        float pixel = 0.004f);

} // namespace toile::evaluation
