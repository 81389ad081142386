// What a garment is made of, as every cloth solver is told it: fabric and welded mesh.
#pragma once

#include "core/types.h"

#include <span>

namespace toile::cloth {

/// SI units; as toile_fabric of the plugin boundary.
struct Fabric {
    float density = 0.2f;         ///< kg/m^2
    float thickness = 0.0005f;    ///< m
    float stretch_warp = 2000.0f; ///< N/m, force per width per unit strain, along v
    float stretch_weft = 2000.0f; ///< N/m, along u
    float shear = 300.0f;         ///< N/m
    float bend_warp = 1e-5f;      ///< N m, bending rigidity per width
    float bend_weft = 1e-5f;      ///< N m
    float friction = 0.4f;        ///< Coulomb, against skin
    float damping = 2.0f;         ///< 1/s, share of relative velocity lost
};

/// One welded garment mesh at rest. Views are borrowed for the call.
struct ClothMesh {
    std::span<const Vec3f> positions;     ///< (nv)
    std::span<const Triangle> triangles;  ///< (nf)
    std::span<const Vec2f> corner_coords; ///< (3 nf) metres, u weft, v warp; or empty: the
                                          ///< positions are the rest state, weft along x
    std::span<const std::array<std::uint32_t, 2>> seams; ///< pairs to hold together
};

/// \throw Error for no triangles, an index out of range, a value that is not finite, a fabric
/// without mass or stiffness
void check(const ClothMesh& mesh, const Fabric& fabric);

/// \throw Error for a triangle without area in its material coordinates
void check_areas(const ClothMesh& mesh);

/// The three corners of a triangle in the plane of its material: u weft, v warp, metres.
[[nodiscard]] std::array<Vec2f, 3> material_corners(const ClothMesh& mesh, std::size_t triangle);

/// Modulus of an orthotropic sheet along a direction of its material (no Poisson coupling), N/m:
/// 1/K = c^4/K_weft + s^4/K_warp + s^2 c^2 / G.
[[nodiscard]] float directional_stiffness(const Fabric& fabric, const Vec2f& unit);

/// Bending rigidity of folds along a direction of the material, N m: they curve it across.
[[nodiscard]] float directional_rigidity(const Fabric& fabric, const Vec2f& unit);

} // namespace toile::cloth
