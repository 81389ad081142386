// From cut pieces and a recipe to a pattern that can be sewn and placed on a body.
#pragma once

#include "garment/block_body.h"
#include "garment/pattern_piece.h"
#include "garment/recipe.h"

namespace toile::garment::block {

/// The probe must outlive the pattern. \throw Error naming panel, edge or point of the recipe that
/// does not fit the pieces
[[nodiscard]] Pattern pattern_of(const Recipe& recipe, std::span<const PatternPiece> pieces,
                                 const BodyProbe& body);

} // namespace toile::garment::block
