// Nearest of many points (a k-d tree, nanoflann).
#pragma once

#include "core/types.h"

#include <memory>
#include <span>
#include <vector>

namespace toile::geometry {

/// Built once, queried often; copies the points. Queries are const and may run side by side.
class PointTree {
  public:
    /// \throw Error for no points or one that is not finite
    explicit PointTree(std::span<const Vec3f> points);
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    struct Neighbour {
        std::uint32_t index = 0;
        float squared = 0.0f; ///< squared distance, m^2
    };
    [[nodiscard]] Neighbour nearest(const Vec3f& point) const;
    /// The nearest `count` (all, when there are fewer), nearest first.
    [[nodiscard]] std::vector<Neighbour> nearest(const Vec3f& point, std::size_t count) const;

    [[nodiscard]] std::span<const Vec3f> points() const noexcept;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

} // namespace toile::geometry
