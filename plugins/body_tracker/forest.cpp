#include "body_tracker/forest.h"

#include "body_tracker/depth_probe.h"

#include <algorithm>
#include <array>

namespace toile::body_tracker {
namespace {

const std::uint8_t* find_leaf(const ForestTree& tree, int class_count, const DepthView& view, int x,
                              int y, std::int64_t scale) {
    std::int32_t at = 0;
    for (;;) {
        const ForestNode& node = tree.nodes[static_cast<std::size_t>(at)];
        if (node.child < 0)
            return &tree.leaves[static_cast<std::size_t>(~node.child) *
                                static_cast<std::size_t>(class_count)];
        at = node.child + (difference(node.feature, view, x, y, scale) < node.threshold ? 0 : 1);
    }
}

} // namespace

int feature_value(const DepthFeature& feature, const DepthView& view, int x, int y) noexcept {
    return difference(feature, view, x, y, pixel_scale(view, view.mm[y * view.width + x]));
}

void classify(const Forest& forest, const DepthView& view, int x, int y,
              std::span<std::uint16_t> sums) noexcept {
    std::fill(sums.begin(), sums.end(), std::uint16_t{0});
    const std::int64_t scale = pixel_scale(view, view.mm[y * view.width + x]);
    for (const ForestTree& tree : forest.trees) {
        const std::uint8_t* leaf = find_leaf(tree, forest.class_count, view, x, y, scale);
        for (std::size_t c = 0; c < sums.size(); ++c)
            sums[c] = static_cast<std::uint16_t>(sums[c] + leaf[c]);
    }
}

void label_pixels(const Forest& forest, const DepthView& view, const LabelPicture& out,
                  int first_row, int last_row) noexcept {
    const int columns = (view.width + out.step - 1) / out.step;
    const int rows = (view.height + out.step - 1) / out.step;
    std::array<std::uint16_t, kMaxClasses> all{};
    const auto sums = std::span(all).first(static_cast<std::size_t>(forest.class_count));
    for (int r = std::max(first_row, 0); r < std::min(last_row, rows); ++r)
        for (int c = 0; c < columns; ++c) {
            const auto at = static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) +
                            static_cast<std::size_t>(c);
            out.labels[at] = out.shares[at] = 0;
            const int x = c * out.step, y = r * out.step;
            if (view.mm[y * view.width + x] == 0) continue;
            classify(forest, view, x, y, sums);
            const auto best = std::max_element(sums.begin(), sums.end());
            out.labels[at] = static_cast<std::uint8_t>(1 + (best - sums.begin()));
            out.shares[at] = static_cast<std::uint8_t>(*best / forest.trees.size());
        }
}

} // namespace toile::body_tracker
