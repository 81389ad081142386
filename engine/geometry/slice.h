// Cuts of a surface by a plane, and girths as a tape measures them.
#pragma once

#include "core/types.h"

#include <span>
#include <vector>

namespace toile::geometry {

/// Points p with normal . p = offset; the normal has unit length.
struct Plane {
    Vec3f normal = Vec3f::UnitY();
    float offset = 0.0f;

    [[nodiscard]] static Plane through(const Vec3f& point, const Vec3f& normal) {
        const Vec3f n = normal.normalized();
        return {n, n.dot(point)};
    }
};

/// One curve of a cut.
struct Loop {
    std::vector<Vec3f> points; ///< in order, the first is not repeated; metres
    bool closed = false;       ///< false: it begins and ends on the surface's border
    /// Of a cut: the triangle that each step from a point to the next runs in, the last step of a
    /// closed curve back to the first point included; empty for curves that are no cut.
    std::vector<std::uint32_t> triangles = {};

    /// Along the curve, back to the start when closed; m.
    [[nodiscard]] double length() const;
    [[nodiscard]] Vec3f centroid() const; ///< of the curve, weighted by length
};

/// All curves in which a plane cuts a mesh, closed ones around closed surfaces; seen against the
/// normal they run counter-clockwise around what is inside. Vertices that lie in the plane count
/// as just above it, so that no curve is lost or doubled. Indices must be in range.
[[nodiscard]] std::vector<Loop> slice(std::span<const Vec3f> positions,
                                      std::span<const Triangle> triangles, const Plane& plane);

/// Convex hull of the points' feet on the plane, counter-clockwise seen against its normal; m.
[[nodiscard]] std::vector<Vec3f> hull_polygon(std::span<const Vec3f> points, const Plane& plane);

/// Length of a tape pulled tight around the points: the perimeter of their convex hull in the
/// plane (P5, figure 9b); m. Twice the length for points in a line.
[[nodiscard]] double hull_girth(std::span<const Vec3f> points, const Plane& plane);

} // namespace toile::geometry
