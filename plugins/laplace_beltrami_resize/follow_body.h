// What lies on a body, or hangs around it, follows when the body changes.
#pragma once

#include "core/row_loop.h"
#include "geometry/mesh.h"

#include <span>

namespace toile::laplace_beltrami_resize {

/// Places of the subject's vertices when the body beneath goes from `before` to `after` (nb each,
/// of one topology): each keeps its offset from the nearest skin, turned as the skin there turns.
/// The farther it hangs from the skin, the wider the moves are smoothed over the subject's own
/// surface; then it is drawn along the normals until its room to the body is what it was.
/// \throw Error when the counts differ or the body has no triangles
[[nodiscard]] std::vector<Vec3f> follow_body(const geometry::TriangleMesh& subject,
                                             const geometry::TriangleMesh& before,
                                             std::span<const Vec3f> after, const RowLoop& rows);

} // namespace toile::laplace_beltrami_resize
