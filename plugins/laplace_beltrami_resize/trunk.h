// The part of a person that is resized: where it is, and how wide and deep at any height.
#pragma once

#include "geometry/mesh.h"
#include "geometry/tape.h"

#include <span>

namespace toile::laplace_beltrami_resize {

/// Weights of a region as toile.resizer/1 has them: the abdomen 1, thighs and chest (trunk beside
/// it) 0.25, arms and hands 0. \throw Error when the surface is no upright person
[[nodiscard]] std::vector<float> abdomen_region(const geometry::TriangleMesh& mesh);

/// Bounding rectangle of one level cut, metres (P3, figure 11: the ellipse's diameters).
struct Strip {
    float height = 0.0f;
    float left = 0.0f, right = 0.0f; ///< lowest and highest x
    float back = 0.0f, front = 0.0f; ///< lowest and highest z

    [[nodiscard]] float width() const { return right - left; }
    [[nodiscard]] float depth() const { return front - back; }
};

/// A surface's trunk. Borrows the mesh.
class Trunk {
  public:
    /// \throw Error when the region is empty or nothing is cut at its heights
    Trunk(const geometry::TriangleMesh& mesh, std::span<const float> region);

    [[nodiscard]] float low() const { return low_; }   ///< of the region
    [[nodiscard]] float high() const { return high_; } ///< metres
    /// Cuts at the middle heights of `count` equal strips, from below.
    [[nodiscard]] std::vector<Strip> strips(std::size_t count) const;
    /// A tape around the trunk there, scaled by `width` along x and `depth` along z: its length.
    [[nodiscard]] double scaled_girth(float height, float width, float depth) const;
    /// Of a tape around the trunk there; 0 where nothing is cut.
    [[nodiscard]] double girth(float height) const;

  private:
    [[nodiscard]] Strip strip(float height) const;

    geometry::SurfacePart part_;
    geometry::GirthCutter cutter_;
    float low_ = 0.0f, high_ = 0.0f;
};

} // namespace toile::laplace_beltrami_resize
