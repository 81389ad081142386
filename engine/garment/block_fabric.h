// Procedural cloth: small tiles of weave and knit that repeat without a seam.
#pragma once

#include "imaging/image.h"

namespace toile::garment::block {

enum class Weave { invalid, jersey, rib, twill };

/// A tile as two pictures of the same size: `shade` multiplies a cloth's colour (nearly white,
/// grey in the hollows), `normal` is a tangent-space normal map (+X right, +Y up, linear).
struct FabricTile {
    imaging::Image shade;
    imaging::Image normal;
    double width_m = 0.0; ///< what the tile covers, square
};

[[nodiscard]] FabricTile make_fabric_tile(Weave weave, int pixels);

} // namespace toile::garment::block
