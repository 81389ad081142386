// Planes that many points lie in, and the floor among them.
#pragma once

#include "geometry/slice.h"

#include <functional>
#include <optional>
#include <span>

namespace toile::geometry {

/// Evenly taken points, about `count` of them.
[[nodiscard]] std::vector<Vec3f> thinned_out(std::span<const Vec3f> points, std::size_t count);

/// Of 300 planes through three points each, drawn from a fixed seed, the one with the best positive
/// `score` among those whose unit normal is accepted. Deterministic.
[[nodiscard]] std::optional<Plane> best_plane(std::span<const Vec3f> points,
                                              const std::function<bool(const Vec3f&)>& accept,
                                              const std::function<double(const Plane&)>& score);

/// Least squares through the points nearer than `reach_m`, a few times; the normal keeps its side.
[[nodiscard]] Plane refined_plane(Plane plane, std::span<const Vec3f> points, float reach_m);

/// The plane with most points that has nearly all others on one side, its normal towards them.
/// `up_hint`: unit, and how far from it the normal may be, radians. Metres. Deterministic.
[[nodiscard]] std::optional<Plane> find_floor(std::span<const Vec3f> points, const Vec3f& up_hint,
                                              float most_angle);

/// Height above the floor of a podium's top, metres, if what was seen stands on one at most 0.35 m
/// high: more points at one height than legs can have, spread over both directions, with at least a
/// quarter of all above.
[[nodiscard]] std::optional<float> podium_top(const Plane& floor, std::span<const Vec3f> points);

} // namespace toile::geometry
