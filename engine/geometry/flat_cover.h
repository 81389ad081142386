// Triangles laid side by side in the plane, none on another.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace toile::geometry {

/// What of the plane is taken. Triangles that meet in sides or corners do not overlap.
class FlatCover {
  public:
    using Corners = std::array<Eigen::Vector2d, 3>;

    /// `cell`: about the size of a triangle, in the units of the plane.
    explicit FlatCover(double cell) : cell_(cell) {}

    /// False, and nothing is added, where it would lie on one that is there.
    bool add(const Corners& triangle);

  private:
    double cell_;
    std::vector<Corners> triangles_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_; ///< triangles of each
};

} // namespace toile::geometry
