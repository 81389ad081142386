// Keeps an outer garment outside an inner one as shown: a push along the inner garment's normals.
// It changes what is drawn, not the simulation: layers do not feel each other yet.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::garment {

/// One pair of garments. Built when they are bound, applied every frame.
class LayerOffset {
  public:
    /// Pairs each outer vertex with the inner garment's nearest point, both as bound. Beside
    /// the inner garment's borders the push fades out over 6 cm; vertices farther than 12 cm stay
    /// free.
    /// inner (ni), outer (no) metres. \throw Error when an index is out of range
    LayerOffset(std::span<const Vec3f> inner, std::span<const Triangle> inner_triangles,
                std::span<const Vec3f> outer);

    /// Moves outer vertices (no) that lie less than `gap_m` outside the inner garment, or inside
    /// it. `inner` and unit `inner_normals` (ni) as they are now. Allocates nothing. [frame]
    void apply(std::span<const Vec3f> inner, std::span<const Vec3f> inner_normals, float gap_m,
               std::span<Vec3f> outer) const noexcept;

    [[nodiscard]] std::size_t pair_count() const { return pairs_.size(); }

  private:
    struct Pair {
        std::uint32_t outer;
        Triangle corners; ///< of the inner garment
        Vec3f barycentric;
        float beside_m; ///< from the inner border when bound, 0 above the garment
        float weight;   ///< 1 above the garment, less beside its border
    };
    std::vector<Pair> pairs_;
};

} // namespace toile::garment
