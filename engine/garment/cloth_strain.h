// How far worn cloth is stretched along warp and weft, and how hard stretched cloth presses.
//
// strain    of a triangle: |F e| - 1, with F the map from its material coordinates to where it is
//           and e the direction of the warp (v) or weft (u). Exact for a uniform stretch. Negative
//           where cloth is pushed together. A vertex has the mean of its triangles, by rest area.
// pressure  of a vertex: the force with which tension pulls it against its outward normal, over its
//           third of the triangles around. Tension is stiffness x strain, of stretched cloth only;
//           around a cylinder this is Laplace's T / r. An estimate: weight, bending and friction
//           are left out, and stiffness is the fabric's at small strains.
#pragma once

#include "geometry/mesh.h"

#include <span>
#include <vector>

namespace toile::garment {

/// Force per width per unit strain, N/m.
struct StretchStiffness {
    double warp_n_m = 0.0;
    double weft_n_m = 0.0;
};

/// Over all triangles of a garment, both directions.
struct StrainFigures {
    double rms = 0.0;       ///< weighted by rest area
    double max = 0.0;       ///< largest stretch; 0 when nothing is stretched
    double rest_area = 0.0; ///< m2
};

/// Built once for a garment, measured as it moves. `measure` and `measure_pressure` allocate
/// nothing. [frame]
class ClothStrain {
  public:
    /// `material_coords` (3 nf) per corner, metres along weft and warp.
    /// \throw Error when an index is out of range, a count differs or a triangle has no rest area
    ClothStrain(std::span<const Triangle> triangles, std::span<const Vec2f> material_coords,
                std::size_t vertex_count);

    /// Positions (nv) as they are now.
    void measure(std::span<const Vec3f> positions) noexcept;
    /// Of the strain measured last. `normals` (nv) unit, outward.
    void measure_pressure(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                          const StretchStiffness& stiffness) noexcept;

    [[nodiscard]] std::span<const float> warp() const { return vertex_warp_; }   ///< (nv)
    [[nodiscard]] std::span<const float> weft() const { return vertex_weft_; }   ///< (nv)
    [[nodiscard]] std::span<const float> triangle_warp() const { return warp_; } ///< (nf)
    [[nodiscard]] std::span<const float> triangle_weft() const { return weft_; } ///< (nf)
    [[nodiscard]] std::span<const float> pressure() const { return pressure_; }  ///< (nv) Pa
    [[nodiscard]] StrainFigures figures() const noexcept;

  private:
    /// What a triangle's rest state gives: rows of the inverse of its material sides, and its area.
    struct Rest {
        Vec2f first, second; ///< gradients of the weights of corners 1 and 2, 1/m
        float area;          ///< m2
    };
    /// Where a unit of warp (v) or weft (u) has come to.
    [[nodiscard]] Vec3f along(std::size_t triangle, int axis,
                              std::span<const Vec3f> positions) const noexcept;
    void average_at_vertices() noexcept;
    void add_forces(std::size_t triangle, std::span<const Vec3f> positions,
                    std::span<const Vec3f> normals, const StretchStiffness& stiffness) noexcept;

    std::vector<Triangle> triangles_;
    std::vector<Rest> rest_;         ///< (nf)
    std::vector<float> vertex_area_; ///< (nv) rest area of the triangles around
    std::vector<float> warp_, weft_; ///< (nf)
    std::vector<float> vertex_warp_, vertex_weft_, pressure_; ///< (nv)
    std::vector<float> force_, area_;                         ///< (nv) inward force, area now
    geometry::VertexAdjacency around_;
};

} // namespace toile::garment
