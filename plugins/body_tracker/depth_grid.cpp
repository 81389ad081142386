#include "body_tracker/depth_grid.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

constexpr int kCells = 160;      // along the longer side
constexpr float kNearest = 0.3f; // metres
constexpr float kFarthest = 10.0f;
constexpr float kOneSurface = 0.08f; // metres between readings of one surface in a cell

} // namespace

DepthReducer::DepthReducer(const imaging::Intrinsics& camera)
    : width_(camera.width), height_(camera.height) {
    imaging::check_intrinsics(camera);
    step_ = std::max(1, (std::max(width_, height_) + kCells / 2) / kCells);
    grid_.width = width_ / step_;
    grid_.height = height_ / step_;
    const auto s = static_cast<float>(step_);
    const float half = 0.5f * (s - 1.0f); // middle of a block, in pixels from its corner
    grid_.fx = static_cast<float>(camera.fx) / s;
    grid_.fy = static_cast<float>(camera.fy) / s;
    grid_.cx = (static_cast<float>(camera.cx) - half) / s;
    grid_.cy = (static_cast<float>(camera.cy) - half) / s;
    corner_.resize(grid_.size());
    for (int y = 0; y < grid_.height; ++y)
        for (int x = 0; x < grid_.width; ++x) {
            std::array<int, 2> at{x * step_, y * step_};
            if (camera.distorted()) {
                const Vec3f ray = grid_.point(static_cast<float>(x), static_cast<float>(y), 1.0f);
                const auto pixel = imaging::project(camera, ray.cast<double>());
                const double away = 2.0 * std::max(width_, height_);
                const Eigen::Vector2d p = pixel.value_or(Eigen::Vector2d(-away, -away));
                for (int k = 0; k < 2; ++k)
                    at[static_cast<std::size_t>(k)] = static_cast<int>(
                        std::lround(std::clamp(p[k], -away, away) - static_cast<double>(half)));
            }
            corner_[static_cast<std::size_t>(y * grid_.width + x)] = at;
        }
}

DepthGrid DepthReducer::blank() const {
    return {grid_, std::vector<float>(grid_.size(), 0.0f)};
}

float DepthReducer::cell_depth(const float* metres, int column, int row) const noexcept {
    const int x0 = std::max(0, column), x1 = std::min(width_, column + step_);
    const int y0 = std::max(0, row), y1 = std::min(height_, row + step_);
    float nearest = kFarthest, farthest = 0.0f, total = 0.0f;
    int seen = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const float d = metres[y * width_ + x];
            const bool valid = d > kNearest && d < kFarthest;
            nearest = valid && d < nearest ? d : nearest;
            farthest = valid && d > farthest ? d : farthest;
            total += valid ? d : 0.0f;
            seen += valid ? 1 : 0;
        }
    if (4 * seen < step_ * step_) return 0.0f;
    if (farthest <= nearest + kOneSurface) return total / static_cast<float>(seen);
    float sum[2] = {0.0f, 0.0f};
    int count[2] = {0, 0};
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const float d = metres[y * width_ + x];
            if (!(d > kNearest && d < kFarthest)) continue;
            const int behind = d > nearest + kOneSurface ? 1 : 0;
            sum[behind] += d;
            ++count[behind];
        }
    const int larger = count[1] > count[0] ? 1 : 0;
    return sum[larger] / static_cast<float>(count[larger]);
}

void DepthReducer::reduce(const float* metres, DepthGrid& out) const noexcept {
    for (std::size_t i = 0; i < corner_.size(); ++i)
        out.depth[i] = cell_depth(metres, corner_[i][0], corner_[i][1]);
}

} // namespace toile::body_tracker
