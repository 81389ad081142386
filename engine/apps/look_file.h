// A dressed person as a 3D file.
#pragma once

#include "pipeline/dressed_person.h"

#include <filesystem>

namespace toile::apps {

/// Body and garments as they stand now, with their materials. \throw Error
void save_look(const pipeline::DressedPerson& person, const std::filesystem::path& file);

} // namespace toile::apps
