// Flattening a disc-shaped piece of surface: conformal start, then as rigid as possible.
#pragma once

#include "geometry/mesh.h"

namespace toile::geometry {

struct FlattenOptions {
    int rigid_iterations = 20; ///< 0: conformal only
};

/// Plane coordinates of every vertex of a disc, in the units of `positions`, every triangle
/// counter-clockwise: least squares conformal map (Levy et al. 2002), then local-global
/// as-rigid-as-possible steps (Liu et al. 2008) as long as no triangle turns over. (nv)
/// \throw Error when the piece is no disc or the map turns a triangle over
[[nodiscard]] std::vector<Vec2f> flatten_disc(std::span<const Vec3f> positions,
                                              std::span<const Triangle> triangles,
                                              const FlattenOptions& options = {});

/// Largest and smallest stretch of a triangle's map to the plane (singular values).
[[nodiscard]] std::array<double, 2> triangle_stretch(const std::array<Vec3f, 3>& surface,
                                                     const std::array<Vec2f, 3>& plane);

} // namespace toile::geometry
