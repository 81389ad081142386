// Curves as round cords that can be drawn.
#pragma once

#include "geometry/mesh.h"
#include "geometry/slice.h"

namespace toile::apps {

/// A round cord along a curve, its middle on it, with normals; an open one ends in knobs of twice
/// the radius. Empty for fewer than two different points.
[[nodiscard]] geometry::TriangleMesh cord(const geometry::Loop& loop, float radius_m);

} // namespace toile::apps
