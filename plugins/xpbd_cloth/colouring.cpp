#include "xpbd_cloth/colouring.h"

#include <algorithm>
#include <bit>

namespace toile::xpbd_cloth {
namespace {

using Colours = std::vector<std::vector<std::uint32_t>>;

/// Colours of the constraints `waiting`. `used` (vertices) is zero, and is again afterwards.
Colours window_colours(std::vector<std::uint32_t> waiting, std::span<const std::uint32_t> corners,
                       std::size_t per, std::span<std::uint64_t> used) {
    // Colours used at each vertex, 64 at a time; what finds none of them waits for the next 64.
    Colours colours;
    while (!waiting.empty()) {
        std::vector<std::uint32_t> left;
        const std::size_t base = colours.size();
        for (const std::uint32_t c : waiting) {
            std::uint64_t taken = 0;
            for (std::size_t k = 0; k < per; ++k) {
                taken |= used[corners[c * per + k]];
            }
            const auto colour = static_cast<std::size_t>(std::countr_one(taken));
            if (colour >= 64) {
                left.push_back(c);
                continue;
            }
            for (std::size_t k = 0; k < per; ++k) {
                used[corners[c * per + k]] |= std::uint64_t{1} << colour;
            }
            if (colours.size() <= base + colour) {
                colours.resize(base + colour + 1);
            }
            colours[base + colour].push_back(c);
        }
        for (const std::uint32_t c : waiting) {
            for (std::size_t k = 0; k < per; ++k) {
                used[corners[c * per + k]] = 0;
            }
        }
        waiting.swap(left);
    }
    return colours;
}

} // namespace

std::vector<std::uint32_t> coloured_order(std::span<const std::uint32_t> corners, std::size_t per,
                                          std::size_t vertex_count, std::size_t group) {
    const std::size_t count = corners.size() / per;
    std::vector<std::uint64_t> used(vertex_count, 0);
    std::vector<std::uint32_t> order;
    for (std::size_t first = 0; first < count; first += kWindow) {
        std::vector<std::uint32_t> window;
        for (std::size_t c = first; c < std::min(first + kWindow, count); ++c) {
            window.push_back(static_cast<std::uint32_t>(c));
        }
        for (const auto& colour : window_colours(std::move(window), corners, per, used)) {
            order.insert(order.end(), colour.begin(), colour.end());
            order.resize((order.size() + group - 1) / group * group, kNoConstraint);
        }
    }
    return order;
}

} // namespace toile::xpbd_cloth
