// A retailer's size chart as a table of text (.csv).
#pragma once

#include "garment/manifest.h"

#include <filesystem>
#include <utility>
#include <vector>

namespace toile::garment {

using SizeChart = std::vector<std::pair<std::string, std::map<std::string, ChartRange>>>;

/// One row a size, in the file's order: the first column names it, each other one measurement by
/// its ISO 8559-1 name ("bust_girth") or as shops say ("bust", "chest", "waist", "hip"), perhaps
/// with its unit ("waist cm"). A cell is a number, two with "-" between, or empty. Without a unit
/// numbers over 3 are centimetres, others metres. Separated by commas, semicolons or tabs; where
/// those are not commas, a comma may stand for the decimal point.
/// \throw Error naming file, line and column
[[nodiscard]] SizeChart read_size_chart(const std::filesystem::path& file);

} // namespace toile::garment
