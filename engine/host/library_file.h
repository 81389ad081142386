// Is a file a whole shared library for this machine? Asked before the loader maps it: the loader
// itself dies of SIGBUS on a truncated one (docs/decisions/plugin_loading.md).
#pragma once

#include "host/refusal.h"

#include <filesystem>

namespace toile::host {

/// Reads the ELF header, program headers and section headers only. \throw PluginRefused, whose
/// text is about `shown` (the manifest or the library itself)
void check_library_file(const std::filesystem::path& library, const std::string& shown);

} // namespace toile::host
