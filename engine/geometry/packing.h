// Boxes packed into a square, for texture atlases.
#pragma once

#include "core/types.h"

#include <span>
#include <vector>

namespace toile::geometry {

struct Packing {
    float side = 0.0f;         ///< of the square, in the units of the boxes
    std::vector<Vec2f> places; ///< (boxes) lowest corner of each in the square
};

/// The least square, to a hundredth, that holds the boxes as they stand, none turned: tallest first
/// on a skyline. `gap`: least distance between boxes and to the border, as a share of the side.
/// \throw Error when there are more boxes than such gaps leave room for
[[nodiscard]] Packing pack_boxes(std::span<const Vec2f> sizes, float gap);

} // namespace toile::geometry
