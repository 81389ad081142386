// Surfaces as level sets on a grid: offsets of a mesh, and from two of them its closing.
#pragma once

#include "geometry/mesh.h"

#include <functional>

namespace toile::geometry {

/// Values at the nodes of a box, x fastest; NaN where not known.
struct NodeField {
    Vec3f origin = Vec3f::Zero();
    float spacing = 0.0f; ///< metres
    std::array<std::int64_t, 3> size{};
    std::vector<float> values; ///< (size[0] * size[1] * size[2])

    [[nodiscard]] std::int64_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return (z * size[1] + y) * size[0] + x;
    }
    [[nodiscard]] Vec3f position(std::int64_t index) const {
        const std::int64_t x = index % size[0], yz = index / size[0];
        return origin + spacing * Vec3f(static_cast<float>(x), static_cast<float>(yz % size[1]),
                                        static_cast<float>(yz / size[1]));
    }
};

/// Zero set of a field by marching tetrahedra, oriented towards positive values; pieces are closed
/// and manifold where all nodes around them are known. Nodes at zero count as just above it.
[[nodiscard]] TriangleMesh level_surface(const NodeField& field);

/// Zero set of `value`, sampled on a grid of `spacing` (metres) at the nodes within `reach(p)` of
/// the triangles of `near` (p: their corners); elsewhere the value counts as positive. Marching
/// tetrahedra: every piece is closed and manifold, oriented towards positive values.
[[nodiscard]] TriangleMesh level_surface(const TriangleMesh& near, float spacing,
                                         const std::function<float(const Vec3f&)>& reach,
                                         const std::function<float(const Vec3f&)>& value);

/// Edge-connected pieces, in order of their first triangle.
[[nodiscard]] std::vector<TriangleMesh> connected_pieces(const TriangleMesh& mesh);

/// The outer surface of `mesh` with its gaps, folds and inner cavities filled: dilated by
/// `radius(p)` metres, then eroded by as much. Every radius must exceed 1.2 `spacing`. Inner
/// sheets, self-intersections and holes narrower than twice the radius do not matter.
/// \throw Error when nothing closed remains
[[nodiscard]] TriangleMesh closed_outer_surface(const TriangleMesh& mesh, float spacing,
                                                const std::function<float(const Vec3f&)>& radius);

/// The half with x >= 0; its border lies on x = 0 exactly.
[[nodiscard]] TriangleMesh clip_to_left_half(const TriangleMesh& mesh);

} // namespace toile::geometry
