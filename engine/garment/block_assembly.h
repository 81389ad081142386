// From a flat pattern to one welded mesh around the body: triangulate, grade, sew, place.
#pragma once

#include "garment/block_triangulate.h"

namespace toile::garment::block {

/// What all sizes of a block share. Side 0 is the body's left (+x), side 1 its mirror image.
struct Assembly {
    double edge_m = 0.0;
    std::size_t sides = 2;                        ///< 1: a pattern of whole panels
    std::vector<FlatMesh> flats;                  ///< (panels) of the base size
    std::vector<std::vector<std::size_t>> pieces; ///< (panels)(curves) edges on each curve
    std::array<std::vector<std::vector<std::uint32_t>>, 2> welded; ///< [side][panel][flat vertex]
    std::vector<std::uint32_t> mirror;         ///< (nv) the mirror image of each vertex; itself
    std::vector<Triangle> triangles;           ///< (nf) counter-clockwise from outside
    std::vector<std::uint16_t> triangle_panel; ///< (nf)
    std::vector<std::uint8_t> triangle_side;   ///< (nf)
    std::vector<Triangle> triangle_flat;       ///< (nf) vertices in the panel's flat mesh

    [[nodiscard]] std::size_t vertex_count() const { return mirror.size(); }
};

/// One size, as placed around its body before it is draped.
struct SizedBlock {
    std::vector<Vec3d> positions;       ///< (nv) metres
    std::vector<Vec2f> material_coords; ///< (3 nf) metres along weft, warp
};

/// Topology from the base size, with edges of about `edge_m`. \throw Error
[[nodiscard]] Assembly assemble(const Pattern& base, double edge_m);

/// A pattern of the same design on that topology: each panel is deformed harmonically from the
/// base size's outline to its own. \throw Error when a panel would fold over
[[nodiscard]] SizedBlock grade(const Assembly& assembly, const Pattern& pattern);

/// The welded vertices along an edge of a panel, in the edge's direction.
[[nodiscard]] std::vector<std::uint32_t> edge_vertices(const Assembly& assembly,
                                                       const Pattern& pattern, int side,
                                                       const std::string& panel,
                                                       const std::string& curve);

} // namespace toile::garment::block
