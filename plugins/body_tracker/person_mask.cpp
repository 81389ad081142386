#include "body_tracker/person_mask.h"

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
    for (std::size_t i = 0; i < mask.cells.size(); ++i) {
        const bool person = mask.cells[i] != 0;
        mask.nearest[i] = person ? static_cast<std::int32_t>(i) : -1;
        mask.count += person ? 1 : 0;
    }
    const Sweep sweep{camera, mask};
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            sweep.take(x, y, -1, 0);
            sweep.take(x, y, -1, -1);
            sweep.take(x, y, 0, -1);
            sweep.take(x, y, 1, -1);
        }
        for (int x = camera.width - 1; x >= 0; --x)
            sweep.take(x, y, 1, 0);
    }
    for (int y = camera.height - 1; y >= 0; --y) {
        for (int x = camera.width - 1; x >= 0; --x) {
            sweep.take(x, y, 1, 0);
            sweep.take(x, y, 1, 1);
            sweep.take(x, y, 0, 1);
            sweep.take(x, y, -1, 1);
        }
        for (int x = 0; x < camera.width; ++x)
            sweep.take(x, y, -1, 0);
    }
}

} // namespace toile::body_tracker
