// The cells that show one person, and for every cell the nearest of them.
#pragma once

#include "body_tracker/depth_grid.h"

#include <array>

namespace toile::body_tracker {

inline constexpr int kMaskReach = 40;

struct PersonMask {
    std::vector<std::uint8_t> cells;   ///< (width * height) 1: of the person
    std::vector<std::int32_t> nearest; ///< (width * height) index of the nearest such cell, or -1
    std::size_t count = 0;
    std::array<int, 2> low{0, 0}, high{-1, -1}; ///< columns and rows of the person's cells

    explicit PersonMask(const GridCamera& camera)
        : cells(camera.size(), 0), nearest(camera.size(), -1) {}
};

/// Fills the rest from `cells` (two sweeps; exact within half a cell). `nearest` is known up to
/// kMaskReach cells around the person, -1 farther out.
void find_nearest(const GridCamera& camera, PersonMask& mask) noexcept;

} // namespace toile::body_tracker
