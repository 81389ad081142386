// `toile garment thumbnail`: a small picture of a garment, for lists and carousels.
#pragma once

#include "apps/global_options.h"

#include <CLI/CLI.hpp>

namespace toile::apps {

void add_garment_thumbnail(CLI::App& garment, const GlobalOptions& global);

} // namespace toile::apps
