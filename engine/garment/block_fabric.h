// Procedural cloth: small tiles of weave and knit that repeat without a seam.
#pragma once

#include "imaging/image.h"

#include <optional>
#include <string>
#include <string_view>

namespace toile::garment::block {

enum class Weave { invalid, jersey, rib, twill, plain, satin, fleece };

/// "jersey", "rib", "twill", "plain", "satin", "fleece".
[[nodiscard]] std::optional<Weave> weave_from_name(std::string_view name);
/// All names, with commas between them.
[[nodiscard]] std::string weave_names();

/// A tile as two pictures of the same size: `shade` multiplies a cloth's colour (nearly white,
/// grey in the hollows), `normal` is a tangent-space normal map (+X right, +Y up, linear).
struct FabricTile {
    imaging::Image shade;
    imaging::Image normal;
    double width_m = 0.0; ///< what the tile covers, square
};

[[nodiscard]] FabricTile make_fabric_tile(Weave weave, int pixels);

} // namespace toile::garment::block
