// Fewer points, evenly: one for each cell of a grid that holds any (P1 2.2, eq. 1-2).
#pragma once

#include "core/types.h"

#include <span>
#include <vector>

namespace toile::scan {

/// Side of the cells, metres: a cbrt(s / c) with c = N / V points per volume of the cloud's box
/// (P1 eq. 1-2, corrected): about `per_cell` (s) points a cell were they spread over the box,
/// `scale` (a) adjusts. 0 for fewer than two points.
[[nodiscard]] double cell_size(std::span<const Vec3f> points, double scale, double per_cell);

/// The centre of gravity of the points in each cell, in the order in which cells are first met.
[[nodiscard]] std::vector<Vec3f> thinned(std::span<const Vec3f> points, double cell_m);

} // namespace toile::scan
