// What a garment's mesh and fabric become for a solver: masses, springs and length limits.
#pragma once

#include "cloth/length_limits.h"
#include "cloth/sheet.h"

#include <span>
#include <vector>

namespace toile::bullet_cloth {

/// Pulls two vertices to their rest distance.
struct Spring {
    std::uint32_t a, b;
    float rest;      ///< m
    float stiffness; ///< N/m
};

using cloth::ClothMesh;
using cloth::Fabric;
using cloth::LengthLimit;

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
