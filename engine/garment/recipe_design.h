// A recipe as a design that block_package.h can make in all sizes.
#pragma once

#include "garment/block_design.h"
#include "garment/pattern_piece.h"
#include "garment/recipe.h"

namespace toile::garment::block {

/// Cuts the pieces for one body: by FreeSewing, or the same for all from a file.
using CutPieces = std::function<std::vector<PatternPiece>(const BodyProbe&)>;

/// \throw Error for an unknown fabric
[[nodiscard]] Design design_of(const Recipe& recipe, CutPieces cut);

} // namespace toile::garment::block
