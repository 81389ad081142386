#include "body_tracker/parts_view.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {

PartsView::PartsView(const Forest* forest, const TrackedBody& body, const GridCamera& camera)
    : forest_(forest) {
    if (forest_ == nullptr) return;
    if (forest_->class_count != kPartCount)
        throw Error("the forest of body parts has " + std::to_string(forest_->class_count) +
                    " classes, but " + std::to_string(kPartCount) +
                    " parts are needed: train it with toile avatar train-parts");
    const std::vector<PartLabel> labels = label_vertices(body.level().skin, body.level().mean);
    for (const Triangle& t : body.level().triangles) {
        // Two of three corners decide.
        const PartLabel label = labels[t[1]] == labels[t[2]] ? labels[t[1]] : labels[t[0]];
        parts_.push_back(static_cast<std::uint8_t>(static_cast<int>(label) - 1));
    }
    mm_.resize(camera.size());
    cells_.reserve(camera.size() / 2 + 1);
}

void PartsView::look(const SeenPerson& seen) noexcept {
    cells_.clear();
    if (forest_ == nullptr) return;
    for (std::size_t i = 0; i < mm_.size(); ++i)
        mm_[i] = seen.mask.cells[i] != 0
                     ? static_cast<std::uint16_t>(std::lround(1000.0f * seen.grid.depth[i]))
                     : std::uint16_t{0};
    const GridCamera& camera = seen.grid.camera;
    const DepthView view{camera.width, camera.height, camera.fx, mm_.data()};
    std::array<std::uint16_t, kPartCount> sums{};
    for (int y = seen.mask.low[1]; y <= seen.mask.high[1]; ++y)
        for (int x = seen.mask.low[0] + (y + seen.mask.low[0]) % 2; x <= seen.mask.high[0];
             x += 2) {
            const auto i = static_cast<std::size_t>(y * camera.width + x);
            if (mm_[i] == 0) continue;
            classify(*forest_, view, x, y, sums);
            Cell cell{static_cast<std::uint32_t>(i), {}};
            for (std::size_t c = 0; c < cell.share.size(); ++c)
                cell.share[c] = static_cast<std::uint8_t>(sums[c] / forest_->trees.size());
            cells_.push_back(cell);
        }
}

float PartsView::support(const Drawing& drawing) const noexcept {
    if (cells_.empty()) return 0.0f;
    std::uint32_t sum = 0;
    for (const Cell& cell : cells_) {
        const DrawnCell& drawn = drawing.cells[cell.index];
        if (drawn.depth != 0.0f)
            sum += cell.share[parts_[static_cast<std::size_t>(drawn.triangle)]];
    }
    return static_cast<float>(sum) / (255.0f * static_cast<float>(cells_.size()));
}

} // namespace toile::body_tracker
