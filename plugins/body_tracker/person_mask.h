// The cells that show one person, and for every cell the nearest of them.
#pragma once

#include "body_tracker/depth_grid.h"

namespace toile::body_tracker {

struct PersonMask {
    std::vector<std::uint8_t> cells;   ///< (width * height) 1: of the person
    std::vector<std::int32_t> nearest; ///< (width * height) index of the nearest such cell, or -1
    std::size_t count = 0;

    explicit PersonMask(const GridCamera& camera)
        : cells(camera.size(), 0), nearest(camera.size(), -1) {}
};

/// Fills `nearest` and `count` from `cells` (two sweeps; exact within half a cell).
void find_nearest(const GridCamera& camera, PersonMask& mask) noexcept;

} // namespace toile::body_tracker
