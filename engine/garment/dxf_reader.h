// Pattern pieces from DXF-AAMA / ASTM D6673 files, as pattern CAD systems write them.
#pragma once

#include "garment/pattern_piece.h"

#include <filesystem>

namespace toile::garment::block {

/// One piece for each block. Layers: 1 cut line, 2 turn points, 4 notches, 7 grain, 8 internal
/// lines (not read), 14 sew line, which is the outline where there is one. Points are named in the
/// outline's order from its lowest left one: turn points p0, p1, ... (the outline's corners where
/// there are none), notches n0, n1, ... A piece is turned so that its grain runs along y. Units are
/// told by the text "UNITS: METRIC" (millimetres) or "ENGLISH" (inches), else by $INSUNITS; without
/// both: millimetres.
/// \throw Error naming file and piece: no DXF, no pieces, an outline that is open, crosses itself
/// or has no area, more than 50 MB
[[nodiscard]] std::vector<PatternPiece> read_dxf(const std::filesystem::path& file);

} // namespace toile::garment::block
