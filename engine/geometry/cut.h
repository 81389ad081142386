// Surfaces cut along the zero line of a field, and two rims sewn together.
#pragma once

#include "geometry/mesh.h"

#include <span>

namespace toile::geometry {

/// Where a vertex of a cut surface comes from: (1 - share) of vertex a and share of vertex b.
struct CutVertex {
    std::uint32_t a = 0, b = 0;
    float share = 0.0f;
};

struct CutMesh {
    TriangleMesh mesh; ///< without normals
    std::vector<CutVertex> from;
};

/// What of the surface has field >= 0 (nv values, linear on the triangles), new vertices along the
/// zero line. Parts that are not connected to the largest are left out with `largest_only`.
[[nodiscard]] CutMesh cut_where(const TriangleMesh& mesh, std::span<const float> field,
                                bool largest_only = true);

/// Borders as rings of vertices, each against its triangles' sense, the longest first.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> rims(const TriangleMesh& mesh);

/// Sews two rings around a vertical axis through `middle` together by triangles that face away
/// from it: vertex numbers of one mesh. Both must go once around the axis.
[[nodiscard]] std::vector<Triangle> sew_rims(std::span<const Vec3f> positions,
                                             std::vector<std::uint32_t> lower,
                                             std::vector<std::uint32_t> upper, const Vec3f& middle);

} // namespace toile::geometry
