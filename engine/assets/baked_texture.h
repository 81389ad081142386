// Colours of a fine surface as a texture on a coarse one.
#pragma once

#include "assets/colored_mesh.h"
#include "core/row_loop.h"

namespace toile::assets {

/// Texture over an atlas: each texel within `gutter` texels of a triangle gets the colour of the
/// place of `fine` that is nearest to its own place on `coarse` and faces the same way; so no seam
/// shows between texels. The rest gets the mean colour. The same bytes whatever `rows` does.
/// `layout` is of `coarse`; `side` in texels. \throw Error when `fine` has no colours or `layout`
/// does not fit
[[nodiscard]] imaging::Image bake_colors(const ColoredMesh& fine,
                                         const geometry::TriangleMesh& coarse,
                                         const geometry::SeamedLayout& layout, int side, int gutter,
                                         const RowLoop& rows = serial_rows);

/// Which triangle of an atlas each texel shows, kNone (-1) for none: the one that its centre lies
/// in, or the nearest within `gutter` texels; the first of several. (side * side), rows from the
/// top
[[nodiscard]] std::vector<int> atlas_triangles(const geometry::SeamedLayout& layout, int side,
                                               int gutter);

/// Cuts the only primitive of the only mesh along the layout's seams, normals and skin included,
/// and puts `texture` on it in the place of its vertices' colours. \throw Error when `layout` does
/// not fit
void put_on(Scene& scene, const geometry::SeamedLayout& layout, Texture texture);

} // namespace toile::assets
