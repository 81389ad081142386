// Runs FreeSewing's designs: node with freesewing/draft.mjs, offline.
#pragma once

#include "garment/pattern_piece.h"

#include <nlohmann/json.hpp>

namespace toile::apps {

/// Cuts the pieces of a design for one body's measurements (cutting_measures: millimetres). Starts
/// a process; half a second.
/// \throw Error when node or the designs are not installed, or with what the design says
[[nodiscard]] std::vector<garment::block::PatternPiece>
draft_freesewing(const std::string& design, const nlohmann::json& options,
                 const std::map<std::string, double>& measurements);

} // namespace toile::apps
