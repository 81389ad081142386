// What is drawn of a block: a finer surface over the simulation mesh, with turned-in edges.
#pragma once

#include "assets/scene.h"
#include "garment/block_assembly.h"

namespace toile::garment::block {

/// A drawn part: the triangles of the panels whose material this is.
struct RenderPart {
    std::string name;
    std::vector<std::uint16_t> panels; ///< pattern panels
    double tile_m = 0.02;              ///< of its texture
    double turn_in_m = 0.012;          ///< width of the strip inside a free edge; 0: none
};

/// One primitive a part, without materials: each triangle of the mesh in four, new vertices on the
/// curved surface that the vertex normals suggest (Vlachos et al. 2001, "Curved PN triangles",
/// edges only), texture coordinates = material coordinates / tile. At a free edge the cloth turns
/// in by its thickness and lies inside for `turn_in_m`.
[[nodiscard]] std::vector<assets::Primitive>
render_parts(const Assembly& assembly, const Pattern& pattern, const SizedBlock& block,
             std::span<const RenderPart> parts, double thickness_m);

} // namespace toile::garment::block
