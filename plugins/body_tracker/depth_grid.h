// A depth picture reduced to a grid of about 160 cells along its longer side, as all tracking works
// on it: a cell takes the mean of the surface that fills most of it.
#pragma once

#include "core/types.h"
#include "imaging/camera.h"

#include <vector>

namespace toile::body_tracker {

/// Pinhole without distortion; (0, 0) is the centre of the top-left cell. Camera frame: looks along
/// -Z, +Y up.
struct GridCamera {
    int width = 0, height = 0;
    float fx = 0.0f, fy = 0.0f, cx = 0.0f, cy = 0.0f;

    [[nodiscard]] std::size_t size() const noexcept {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    [[nodiscard]] Vec3f point(float x, float y, float depth) const noexcept {
        return {(x - cx) / fx * depth, (cy - y) / fy * depth, -depth};
    }
    /// Column and row of a point in front of the camera.
    [[nodiscard]] Vec2f cell(const Vec3f& point) const noexcept {
        const float s = -1.0f / point.z();
        return {cx + fx * point.x() * s, cy - fy * point.y() * s};
    }
    /// Width of a cell at a depth, metres.
    [[nodiscard]] float footprint(float depth) const noexcept { return depth / fx; }
};

struct DepthGrid {
    GridCamera camera;
    std::vector<float> depth; ///< (width * height) metres along the axis; 0: no reading
};

/// Reduces pictures of one camera; its distortion is undone on the way.
class DepthReducer {
  public:
    /// \throw Error when the intrinsics make no sense
    explicit DepthReducer(const imaging::Intrinsics& camera);

    [[nodiscard]] const GridCamera& grid() const noexcept { return grid_; }
    /// Pixels of the camera along a cell.
    [[nodiscard]] int step() const noexcept { return step_; }
    /// `metres` (width * height of the camera; NaN, 0 or beyond 10 m: no reading). `out` must have
    /// been made by `blank`.
    void reduce(const float* metres, DepthGrid& out) const noexcept;
    [[nodiscard]] DepthGrid blank() const;

  private:
    [[nodiscard]] float cell_depth(const float* metres, int column, int row) const noexcept;

    int width_ = 0, height_ = 0, step_ = 1;
    GridCamera grid_;
    std::vector<std::array<int, 2>> corner_; // (cells) top left pixel of each cell's block
};

} // namespace toile::body_tracker
