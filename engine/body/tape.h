// Measurements of a surface with their derivatives: what a tape reads, and which way each vertex
// moves it. Made for solvers; docs/measurements.md has the measurements of a finished body.
#pragma once

#include "core/types.h"

#include <span>
#include <utility>
#include <vector>

namespace toile::body {

/// A value and its derivative to the vertices it depends on (others: zero).
struct Measured {
    double value = 0.0;
    std::vector<std::pair<std::uint32_t, Vec3f>> slope; ///< vertex, per metre
};

/// A tape pulled tight around the cut of `triangles` by a plane (P5 fig. 9b): the perimeter of the
/// convex hull, metres. The plane stands across the unit vector `axis` through `point`. When the
/// body changes, the plane moves along the axis with vertex `rider`, or without one with the mean
/// of the hull's corners; it does not tilt. Zero when the cut is empty.
[[nodiscard]] Measured tape_girth(std::span<const Vec3f> positions,
                                  std::span<const Triangle> triangles, const Vec3f& point,
                                  const Vec3f& axis, const std::uint32_t* rider = nullptr);

/// Distance of two vertices, metres.
[[nodiscard]] Measured tape_distance(std::span<const Vec3f> positions, std::uint32_t a,
                                     std::uint32_t b);

/// Component along `axis` from vertex a to b, metres.
[[nodiscard]] Measured tape_rise(std::span<const Vec3f> positions, std::uint32_t a, std::uint32_t b,
                                 const Vec3f& axis);

/// Enclosed volume, m^3.
[[nodiscard]] Measured tape_volume(std::span<const Vec3f> positions,
                                   std::span<const Triangle> triangles);

} // namespace toile::body
