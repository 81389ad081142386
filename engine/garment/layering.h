// Keeps an outer garment outside an inner one as shown: a push along the inner garment's normals.
// It changes what is drawn, not the simulation: layers do not feel each other yet.
#pragma once

#include "geometry/mesh.h"
#include "geometry/surface_walk.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::garment {

/// One garment of a pair as it was bound. Views are borrowed for the call.
struct LayerSurface {
    std::span<const Vec3f> positions;    ///< (nv) metres
    std::span<const Triangle> triangles; ///< (nf)
};

/// One pair of garments. Built when they are bound, applied every frame. Samples of the outer
/// garment (vertices and triangle centres) follow their nearest places on the inner one as both
/// move.
class LayerOffset {
  public:
    /// Samples farther than 12 cm from the inner garment as bound stay free.
    /// \throw Error when an index is out of range
    LayerOffset(const LayerSurface& inner, const LayerSurface& outer);

    /// Moves outer vertices (no) so that its samples lie at least `gap_m` outside the inner
    /// garment, and their surroundings with them, so that no dent shows. Beside the inner one's
    /// borders the push fades out over 6 cm; what lies beyond stays where it is. `inner` and unit
    /// `inner_normals` (ni) as they are now. Allocates nothing. [frame]
    void apply(std::span<const Vec3f> inner, std::span<const Vec3f> inner_normals, float gap_m,
               std::span<Vec3f> outer) noexcept;

    [[nodiscard]] std::size_t sample_count() const { return samples_.size(); }

  private:
    /// The mean of one or three outer vertices, over a triangle of the inner garment.
    struct Sample {
        std::array<std::uint32_t, 3> vertices;
        std::uint32_t count;
        std::uint32_t beneath; ///< triangle of the inner garment
    };
    /// Where a sample must stay, this frame: normal . p - height >= gap.
    struct Plane {
        Vec3f normal;
        float height;
        float weight; ///< 1 above the garment, less beside its border, 0: free
    };

    [[nodiscard]] Plane plane_beneath(const Vec3f& p, std::span<const Vec3f> inner_normals,
                                      Sample& sample) const noexcept;

    void spread() noexcept;
    void push_out(float gap_m, std::span<const Vec3f> outer) noexcept;

    geometry::SurfaceWalk walk_;
    geometry::VertexAdjacency around_;  ///< of the outer garment
    std::vector<Vec4f> inner_;          ///< (ni) as now
    std::vector<Sample> samples_;       ///< centres, then vertices
    std::vector<Plane> planes_;         ///< (samples)
    std::vector<Vec3f> moved_, spread_; ///< (no) this frame's push
    std::vector<float> share_; ///< (no) of its push that a vertex takes: 0 beyond the inner garment
};

} // namespace toile::garment
