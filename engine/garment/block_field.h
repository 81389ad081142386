// Signed distance to a closed surface on a grid, near the surface.
#pragma once

#include "core/types.h"
#include "geometry/mesh.h"

#include <vector>

namespace toile::garment::block {

/// Distances within `reach_m` of the surface, negative inside, trilinear between grid points.
class DistanceField {
  public:
    /// \throw Error when the grid would be too large
    DistanceField(const geometry::TriangleMesh& surface, double cell_m, double reach_m);

    /// Metres; `gradient` gets the direction away from the surface (unit, or zero far from it).
    [[nodiscard]] double at(const Vec3d& p, Vec3d& gradient) const;

  private:
    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * size_[1] + y) * size_[0] + x;
    }

    double cell_, reach_;
    Vec3d low_;
    std::array<int, 3> size_{};
    std::vector<float> values_;
};

} // namespace toile::garment::block
