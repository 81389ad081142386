#include "body_tracker/person_mask.h"

#include <algorithm>

namespace toile::body_tracker {
namespace {

/// Hands a neighbour's nearest cell on where it is nearer.
struct Sweep {
    const GridCamera& camera;
    PersonMask& mask;

    [[nodiscard]] int squared(int x, int y, std::int32_t cell) const noexcept {
        const int dx = cell % camera.width - x, dy = cell / camera.width - y;
        return dx * dx + dy * dy;
    }
    void take(int x, int y, int dx, int dy) const noexcept {
        const int nx = x + dx, ny = y + dy;
        if (nx < 0 || ny < 0 || nx >= camera.width || ny >= camera.height) return;
        const std::int32_t theirs = mask.nearest[static_cast<std::size_t>(ny * camera.width + nx)];
        if (theirs < 0) return;
        std::int32_t& mine = mask.nearest[static_cast<std::size_t>(y * camera.width + x)];
        if (mine < 0 || squared(x, y, theirs) < squared(x, y, mine)) mine = theirs;
    }
};

} // namespace

void find_nearest(const GridCamera& camera, PersonMask& mask) noexcept {
    mask.count = 0;
    mask.low = {camera.width, camera.height};
    mask.high = {-1, -1};
    std::size_t i = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x, ++i) {
            mask.nearest[i] = -1;
            if (mask.cells[i] == 0) continue;
            mask.nearest[i] = static_cast<std::int32_t>(i);
            ++mask.count;
            mask.low = {std::min(mask.low[0], x), std::min(mask.low[1], y)};
            mask.high = {std::max(mask.high[0], x), std::max(mask.high[1], y)};
        }
    if (mask.count == 0) return;
    const int x0 = std::max(0, mask.low[0] - kMaskReach);
    const int x1 = std::min(camera.width - 1, mask.high[0] + kMaskReach);
    const int y0 = std::max(0, mask.low[1] - kMaskReach);
    const int y1 = std::min(camera.height - 1, mask.high[1] + kMaskReach);
    const Sweep sweep{camera, mask};
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            sweep.take(x, y, -1, 0);
            sweep.take(x, y, -1, -1);
            sweep.take(x, y, 0, -1);
            sweep.take(x, y, 1, -1);
        }
        for (int x = x1; x >= x0; --x)
            sweep.take(x, y, 1, 0);
    }
    for (int y = y1; y >= y0; --y) {
        for (int x = x1; x >= x0; --x) {
            sweep.take(x, y, 1, 0);
            sweep.take(x, y, 1, 1);
            sweep.take(x, y, 0, 1);
            sweep.take(x, y, -1, 1);
        }
        for (int x = x0; x <= x1; ++x)
            sweep.take(x, y, -1, 0);
    }
}

} // namespace toile::body_tracker
