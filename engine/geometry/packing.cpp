#include "geometry/packing.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace toile::geometry {
namespace {

constexpr float kMostWaste = 30.0f; // side of the square in sides of what all boxes need

/// Bottom-left on a skyline; the height reached, or infinity when a box is wider than `side`.
float pack(std::span<const Vec2f> sizes, std::span<const std::size_t> order, float side, float gap,
           std::vector<Vec2f>& places) {
    constexpr int kColumns = 512;
    std::vector<float> skyline(kColumns, gap);
    float top = 0.0f;
    const float column = side / static_cast<float>(kColumns);
    for (const std::size_t box : order) {
        const int width = static_cast<int>(std::ceil((sizes[box].x() + gap) / column));
        if (width > kColumns) return std::numeric_limits<float>::max();
        int best = 0;
        float lowest = std::numeric_limits<float>::max();
        for (int x = static_cast<int>(std::ceil(gap / column)); x + width <= kColumns; ++x) {
            const float y = *std::max_element(skyline.begin() + x, skyline.begin() + x + width);
            if (y < lowest) {
                lowest = y;
                best = x;
            }
        }
        if (lowest == std::numeric_limits<float>::max()) return lowest;
        places[box] = Vec2f(static_cast<float>(best) * column, lowest);
        std::fill(skyline.begin() + best, skyline.begin() + best + width,
                  lowest + sizes[box].y() + gap);
        top = std::max(top, lowest + sizes[box].y() + gap);
        if (top > side) break; // too small a square already
    }
    return top;
}

} // namespace

Packing pack_boxes(std::span<const Vec2f> sizes, float gap) {
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sizes[a].y() > sizes[b].y(); });
    float area = 0.0f;
    for (const Vec2f& size : sizes)
        area += size.prod();
    Packing out;
    out.places.resize(sizes.size(), Vec2f::Zero());
    const float least = std::sqrt(area);
    for (out.side = least; out.side <= kMostWaste * least; out.side *= 1.01f)
        if (pack(sizes, order, out.side, out.side * gap, out.places) <= out.side) return out;
    throw Error(std::to_string(sizes.size()) +
                " pieces do not fit into one texture with gaps between them: it must be larger");
}

} // namespace toile::geometry
