// The depth difference that a node asks for, shared by the walk and the training.
#pragma once

#include "body_tracker/forest.h"

namespace toile::body_tracker {

/// Pixels a millimetre at a depth, 16 binary places.
inline std::int64_t pixel_scale(const DepthView& view, int depth_mm) noexcept {
    return static_cast<std::int64_t>(view.focal_px * 65536.0f) / depth_mm;
}

/// Depth at an offset from a pixel; kFar_mm where nobody is.
inline int probe(const DepthView& view, int x, int y, std::int64_t scale, int dx_mm,
                 int dy_mm) noexcept {
    const std::int64_t px = x + ((dx_mm * scale + 32768) >> 16);
    const std::int64_t py = y + ((dy_mm * scale + 32768) >> 16);
    // Without branches: where a place falls is hard to predict. Negative ones wrap to huge ones.
    const bool inside = (static_cast<std::uint64_t>(px) < static_cast<std::uint64_t>(view.width)) &
                        (static_cast<std::uint64_t>(py) < static_cast<std::uint64_t>(view.height));
    const int depth = view.mm[inside ? py * view.width + px : 0];
    return inside & (depth != 0) ? depth : kFar_mm;
}

inline int difference(const DepthFeature& f, const DepthView& view, int x, int y,
                      std::int64_t scale) noexcept {
    return probe(view, x, y, scale, f.ax, f.ay) - probe(view, x, y, scale, f.bx, f.by);
}

} // namespace toile::body_tracker
