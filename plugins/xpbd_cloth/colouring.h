// Constraints in colours: those of one colour share no vertex, so that eight can be solved at once
// and in any order. Colours are of a window of the constraints, so that what one window touches
// stays in the processor's nearest memory until it is done.
#pragma once

#include "core/types.h"

#include <span>
#include <vector>

namespace toile::xpbd_cloth {

/// Stands for an empty place in a group of eight.
inline constexpr std::uint32_t kNoConstraint = 0xffffffffu;

/// Constraints in a window.
inline constexpr std::size_t kWindow = 1024;

/// Window by window greedy colours in the order of `corners` (count x `per`, vertex indices), each
/// colour filled up to whole groups of `group` with kNoConstraint. Within a colour the order is
/// kept.
/// \return (a multiple of group) constraint numbers
[[nodiscard]] std::vector<std::uint32_t> coloured_order(std::span<const std::uint32_t> corners,
                                                        std::size_t per, std::size_t vertex_count,
                                                        std::size_t group);

} // namespace toile::xpbd_cloth
