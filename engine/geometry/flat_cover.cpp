#include "geometry/flat_cover.h"

#include <algorithm>
#include <cmath>

namespace toile::geometry {
namespace {

using Corners = FlatCover::Corners;
using Vec2d = Eigen::Vector2d;

constexpr double kTouching = 1e-7; // metres: rounding of corners that two triangles share

/// Whether a side of `a` has all of `b` on its far side.
bool side_parts(const Corners& a, const Corners& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2d along = a[(k + 1) % 3] - a[k];
        const double length = along.norm();
        if (length == 0.0) continue;
        const Vec2d inward = Vec2d(-along.y(), along.x()) / length; // of a counter-clockwise one
        double deepest = (b[0] - a[k]).dot(inward);
        for (std::size_t i = 1; i < 3; ++i)
            deepest = std::max(deepest, (b[i] - a[k]).dot(inward));
        if (deepest <= kTouching) return true;
    }
    return false;
}

std::uint64_t key(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32) ^ static_cast<std::uint32_t>(y);
}

} // namespace

bool FlatCover::add(const Corners& triangle) {
    const Vec2d low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]) / cell_;
    const Vec2d high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]) / cell_;
    std::vector<std::uint64_t> keys;
    for (auto y = static_cast<std::int64_t>(std::floor(low.y()));
         y <= static_cast<std::int64_t>(std::floor(high.y())); ++y)
        for (auto x = static_cast<std::int64_t>(std::floor(low.x()));
             x <= static_cast<std::int64_t>(std::floor(high.x())); ++x)
            keys.push_back(key(x, y));
    for (const std::uint64_t k : keys) {
        const auto there = cells_.find(k);
        if (there == cells_.end()) continue;
        for (const std::uint32_t other : there->second)
            if (!side_parts(triangle, triangles_[other]) &&
                !side_parts(triangles_[other], triangle))
                return false;
    }
    for (const std::uint64_t k : keys)
        cells_[k].push_back(static_cast<std::uint32_t>(triangles_.size()));
    triangles_.push_back(triangle);
    return true;
}

} // namespace toile::geometry
