// One screen of the mirror without a camera: for translators, and for tests of pictures.
#pragma once

#include "apps/kiosk/config.h"

#include <filesystem>
#include <string>

namespace toile::apps::kiosk {

/// Draws with the configured language, size and garments. \throw UsageError listing the screens
/// for one that there is not, Error
void preview(const KioskConfig& config, const std::string& screen,
             const std::filesystem::path& file);

} // namespace toile::apps::kiosk
