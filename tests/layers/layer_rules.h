// Which folder may use which, and who may use which third-party library; docs/layers.md tells why.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile::test {

/// Walks a source tree (engine/, plugins/) and returns one line for every include or link line
/// that is not an arrow of the design: "engine/core/x.h:3: core may not include geometry".
/// Unknown third-party headers and folders are findings too.
[[nodiscard]] std::vector<std::string> check_layers(const std::filesystem::path& root);

} // namespace toile::test
