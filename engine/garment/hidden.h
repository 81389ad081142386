// What of a garment is never seen because others are worn over it.
#pragma once

#include "garment/contact_metrics.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::garment {

struct HiddenOptions {
    float offset_m = 0.003f; ///< rays start so far outside the cloth
    float reach_m = 2.0f;    ///< farther off nothing hides
    /// Cloth this near to some that can be seen stays drawn: layers slide over each other.
    float margin_m = 0.10f;
};

/// For each triangle of `inner` (nf) 1 when it need not be drawn: from none of its corners does a
/// ray in any of 48 directions of the outer half space pass by the garments over it, the body and
/// itself, and nothing within `margin_m` (along the cloth) can be seen either. All as worn in one
/// pose; `inner_normals` (nv) unit, outward.
/// \throw Error when an index is out of range or a position is not finite
[[nodiscard]] std::vector<std::uint8_t> hidden_triangles(const ClothSurface& inner,
                                                         std::span<const Vec3f> inner_normals,
                                                         std::span<const ClothSurface> over,
                                                         const ClothSurface& body,
                                                         const HiddenOptions& options = {});

} // namespace toile::garment
