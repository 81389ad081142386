// What the pages of the repository point at must be there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile::test {

/// Relative links of every .md file below `root`, with their #headings, and every mention of a page
/// of docs/ in pages, sources and scripts; links to other hosts are not followed. One line
/// "FILE:LINE: WHAT" for each that leads nowhere, sorted. Skips build, out, node_modules and
/// folders whose name starts with a dot.
[[nodiscard]] std::vector<std::string> broken_links(const std::filesystem::path& root);

} // namespace toile::test
