// Isotropic remeshing with a sizing field (Botsch and Kobbelt 2004: split, collapse, flip, relax).
#pragma once

#include "geometry/mesh.h"

#include <functional>

namespace toile::geometry {

struct RemeshOptions {
    int iterations = 12;
    std::function<float(const Vec3f&)> edge_length; ///< wanted length at a point, metres
    std::function<Vec3f(const Vec3f&)> project;     ///< point of the surface near a point
    bool border_on_x0 = false; ///< border vertices stay on the plane x = 0 (half of a mirror pair)
};

/// A near-uniform triangulation of the same surface. The input must be manifold; a border stays a
/// border, and no inner edge of the result joins two border vertices, so that the mirror image can
/// be sewn on. \throw Error when the input is not manifold
[[nodiscard]] TriangleMesh remesh(const TriangleMesh& mesh, const RemeshOptions& options);

/// A half with its border on x = 0 and its mirror image, welded. Vertices [0, n) are those of
/// `half`; `mirror_of` (nv) gets each vertex's counterpart.
[[nodiscard]] TriangleMesh mirror_and_weld(const TriangleMesh& half,
                                           std::vector<std::uint32_t>& mirror_of);

} // namespace toile::geometry
