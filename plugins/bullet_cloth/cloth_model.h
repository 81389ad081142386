// What a garment's mesh and fabric become for a solver: masses, springs and length limits.
#pragma once

#include "core/types.h"

#include <span>
#include <vector>

namespace toile::bullet_cloth {

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

/// Pulls two vertices to their rest distance.
struct Spring {
    std::uint32_t a, b;
    float rest;      ///< m
    float stiffness; ///< N/m
};

/// Two vertices that the cloth between them never lets further apart.
struct LengthLimit {
    std::uint32_t a, b;
    float longest; ///< m, along the material
};

/// One welded garment mesh at rest. Views are borrowed for the call.
struct ClothMesh {
    std::span<const Vec3f> positions;     ///< (nv)
    std::span<const Triangle> triangles;  ///< (nf)
    std::span<const Vec2f> corner_coords; ///< (3 nf) metres, u weft, v warp; or empty: the
                                          ///< positions are the rest state, weft along x
    std::span<const std::array<std::uint32_t, 2>> seams; ///< pairs to hold together
};

struct ClothModel {
    std::vector<float> mass;         ///< (nv) kg
    std::vector<Spring> stretch;     ///< one per mesh edge, then the seams
    std::vector<Spring> bend;        ///< over each inner edge
    std::vector<LengthLimit> limits; ///< about `limit_edges` edges long
    float mean_edge = 0.0f;          ///< m
    double area = 0.0;               ///< m^2, of the material
};

/// Stretch springs carry the membrane stiffness of the two triangles at an edge,
/// k = K(direction) A / l^2, with the orthotropic K of warp, weft and shear; bending springs
/// between the vertices opposite an edge carry the energy of a hinge of the fabric's rigidity at
/// a fold of half a radian. Limits reach over `limit_edges` edges (0: none).
/// \throw Error for no triangles, an index out of range, a triangle without material area, a
/// fabric without mass or stiffness
[[nodiscard]] ClothModel make_cloth_model(const ClothMesh& mesh, const Fabric& fabric,
                                          float limit_edges);

} // namespace toile::bullet_cloth
