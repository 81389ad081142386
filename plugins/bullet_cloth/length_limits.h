// Long-range limits: what keeps a stack of stiff springs from stretching like rubber when a
// serial solver passes over it only once a substep.
#pragma once

#include "bullet_cloth/cloth_model.h"

namespace toile::bullet_cloth {

/// Pairs about `reach` metres apart along the material, at most four started at each vertex, in
/// directions as different as the mesh allows. Distances run over edges and over the diagonals
/// of edge-opposite vertices, so they exceed the true ones by about 1 % and never fall below.
[[nodiscard]] std::vector<LengthLimit> make_length_limits(std::size_t vertex_count,
                                                          std::span<const Spring> stretch,
                                                          std::span<const Spring> bend,
                                                          float reach);

} // namespace toile::bullet_cloth
