// A file that is there whole or as it was before: written beside it, then renamed.
#pragma once

#include <filesystem>
#include <string_view>

namespace toile::apps::kiosk {

/// \throw Error when it cannot be written (a full disk); the old file then stays
void write_whole(const std::filesystem::path& file, std::string_view text);

} // namespace toile::apps::kiosk
