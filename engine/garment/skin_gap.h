// How far each vertex of a garment stands off the skin, followed from frame to frame.
#pragma once

#include "geometry/surface_walk.h"

#include <span>
#include <vector>

namespace toile::garment {

/// A posed body's surface; views are borrowed for the call.
struct SkinSurface {
    std::span<const Vec3f> positions; ///< (nb) metres
    std::span<const Vec3f> normals;   ///< (nb) unit, outward
};

/// Distance to the nearest skin, negative inside the body. Cloth that touches lies a few
/// millimetres off: its thickness and the distance that the cloth solver keeps.
class SkinGap {
  public:
    /// \throw Error when an index is out of range
    SkinGap(std::span<const Triangle> body_triangles, std::size_t body_vertices,
            std::size_t cloth_vertices);

    /// Looks everywhere. Allocates. \throw Error when a count differs or a position is not finite
    void find(const SkinSurface& body, std::span<const Vec3f> cloth);
    /// Looks around the places found last: for cloth that moved on a little. Allocates nothing.
    /// [frame]
    void follow(const SkinSurface& body, std::span<const Vec3f> cloth) noexcept;

    [[nodiscard]] std::span<const float> gaps() const { return gaps_; } ///< (nc) metres
    /// (nc) triangle of the body beneath each vertex.
    [[nodiscard]] std::span<const std::uint32_t> beneath() const { return beneath_; }
    [[nodiscard]] std::span<const Triangle> body_triangles() const { return walk_.triangles(); }

  private:
    geometry::SurfaceWalk walk_;
    std::vector<Vec4f> rows_; ///< (nb)
    std::vector<float> gaps_;
    std::vector<std::uint32_t> beneath_;
};

} // namespace toile::garment
