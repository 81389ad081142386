// The page of `toile report`: one HTML file with everything in it.
#pragma once

#include "body/measurement.h"
#include "garment/fit.h"
#include "imaging/image.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace toile::apps {

struct ReportPictures {
    std::vector<std::pair<std::string, imaging::Image>> views; ///< caption, picture; at least one
    imaging::Image ease_map, strain_map;                       ///< with their legends
    imaging::Image tapes;
};

struct ReportContent {
    std::string title, subtitle;
    garment::FitReport fit;
    std::vector<body::LaidMeasurement> measurements;
    ReportPictures pictures;
    std::vector<std::uint8_t> look; ///< .glb
    std::vector<std::string> notes; ///< a sentence each
};

/// The skeleton of the page and the viewer's code stand in `folder` (program_folder()/report).
/// Nothing in the page reaches outside of it. Equal content gives equal bytes.
/// \throw Error when a part is missing (scripts/setup fetches the viewer)
[[nodiscard]] std::string report_page(const ReportContent& content,
                                      const std::filesystem::path& folder);

/// & < > " as HTML writes them.
[[nodiscard]] std::string html_text(std::string_view text);
/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

} // namespace toile::apps
