// The mannequin's abdomen to the customer's, strip by strip (P3 4.1).
#pragma once

#include "geometry/mesh.h"

#include <span>

namespace toile::laplace_beltrami_resize {

inline constexpr std::uint32_t kStrips = 40; ///< as in P3
inline constexpr std::uint32_t kMostStrips = 1000;

/// Places of the subject's vertices after each strip got the width and depth of the target's strip
/// of the same number, and its girth: scaled about the strip's own middle, since the paper's
/// scaling about the origin shifts it. Between strips and beyond both ends the ratios go over
/// smoothly, so that no number of strips leaves a gap (the paper's does when they are few). \throw
/// Error when a region is empty, or `strips` is none or more than kMostStrips
[[nodiscard]] std::vector<Vec3f> resize_strips(const geometry::TriangleMesh& subject,
                                               std::span<const float> region,
                                               const geometry::TriangleMesh& target,
                                               std::span<const float> target_region,
                                               std::uint32_t strips = kStrips);

} // namespace toile::laplace_beltrami_resize
