// fit.json: how worn garments fit (docs/file_formats.md, docs/schemas/fit.schema.json).
#pragma once

#include "garment/fit.h"

#include <filesystem>

namespace toile::garment {

/// Equal reports give equal bytes; ends with a newline. Numbers of vertices stand in one line a
/// list.
[[nodiscard]] std::string fit_text(const FitReport& report);

/// \throw Error when the file cannot be written
void write_fit(const FitReport& report, const std::filesystem::path& file);

} // namespace toile::garment
