// Material coordinates for a mesh that has none: charts laid flat with true lengths.
#pragma once

#include "geometry/mesh.h"

#include <span>
#include <vector>

namespace toile::garment {

struct Flattening {
    std::vector<Vec2f> coords; ///< (3 nf) per corner, metres; v runs up the body (warp)
    std::size_t charts = 0;
    std::size_t loose_triangles = 0; ///< that no chart holds within 5 %; laid out on their own
    double mean_strain = 0.0;        ///< of the charts against the mesh, area-weighted
};

/// Charts follow the seams of `texcoords` (3 nf per corner, any scale; empty: grown by the
/// direction of the surface). Each is laid flat as rigidly as possible (Liu et al. 2008, ARAP
/// local/global), scaled to metres, its warp turned to world +Y. Charts stand side by side. \throw
/// Error when a chart's system cannot be solved
[[nodiscard]] Flattening flatten(const geometry::TriangleMesh& mesh,
                                 std::span<const Vec2f> texcoords);

/// The flat pattern of a garment that was carried from `mesh.positions` to `carried` (nv): charts
/// as in `coords` (3 nf per corner), each triangle stretched along the cloth as its carried one is
/// against the old one, evened out over a hand's breadth, laid flat as rigidly as possible; grain
/// and place of each chart stay.
/// (3 nf) \throw Error when a triangle has no area or a system cannot be solved
[[nodiscard]] std::vector<Vec2f> flatten_carried(const geometry::TriangleMesh& mesh,
                                                 std::span<const Vec2f> coords,
                                                 std::span<const Vec3f> carried);

} // namespace toile::garment
