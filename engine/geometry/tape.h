// A measuring tape on a surface: girths around a part of it, and taut paths between two points.
#pragma once

#include "geometry/slice.h"

#include <span>
#include <vector>

namespace toile::geometry {

/// Some triangles of a surface, prepared for being cut many times while the surface changes shape.
class SurfacePart {
  public:
    SurfacePart() = default;
    /// `triangles` name vertices of the whole surface.
    explicit SurfacePart(std::vector<Triangle> triangles);

    [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
    [[nodiscard]] std::span<const std::uint32_t> vertices() const { return vertices_; } ///< rising
    /// Each once, as places in `vertices()`.
    [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> edges() const { return edges_; }
    [[nodiscard]] bool empty() const { return triangles_.empty(); }

  private:
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> vertices_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
};

/// Girths of a part in planes across one direction. Borrows the positions and the part.
class GirthCutter {
  public:
    /// `normal` has unit length.
    GirthCutter(std::span<const Vec3f> positions, const SurfacePart& part, const Vec3f& normal);

    /// Of a tape pulled tight around the part where normal . p = offset (a convex hull: P5, figure
    /// 9b); m, 0 where the plane misses the part. Continuous in the positions and the offset.
    [[nodiscard]] double girth(float offset) const;
    /// The tape itself, closed.
    [[nodiscard]] Loop tape(float offset) const;

    /// How far the cut reaches in a direction: the largest direction . p; -infinity where the plane
    /// misses the part.
    [[nodiscard]] float extent(float offset, const Vec3f& direction) const;

    [[nodiscard]] const Vec3f& normal() const { return normal_; }
    [[nodiscard]] float offset(const Vec3f& point) const { return normal_.dot(point); }

  private:
    template <typename Visit>
    void cut(float offset, const Visit& visit) const;

    std::span<const Vec3f> positions_;
    const SurfacePart& part_;
    Vec3f normal_;
    std::vector<float> heights_; // of the part's vertices along the normal
};

/// Which of the two ways round a tape takes.
enum class Way : std::uint8_t {
    invalid,
    far_side, ///< the one that lies farther to the given side
    shorter,
};

/// A tape pulled tight over the surface from one point on it to another, in the plane that holds
/// both and the direction `side`. It spans hollows, and ends exactly in the given points; the
/// straight line where the plane finds no curve through both. `triangles`: those it may touch.
[[nodiscard]] Loop taut_path(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                             const Vec3f& from, const Vec3f& to, const Vec3f& side,
                             Way way = Way::far_side);

} // namespace toile::geometry
