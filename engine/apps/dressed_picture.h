// What `toile dress` did, as a picture.
#pragma once

#include "pipeline/mannequin_dressing.h"

#include <filesystem>

namespace toile::apps {

/// Mannequin, customer and result, from the front and from the side. \throw Error
void save_dressed_picture(const pipeline::MannequinDressing& dressed,
                          const std::filesystem::path& file);

} // namespace toile::apps
