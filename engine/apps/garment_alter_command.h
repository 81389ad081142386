// `toile garment alter`: a garment made anew for one person.
#pragma once

#include "apps/global_options.h"
#include "garment/package.h"

#include <CLI/CLI.hpp>
#include <functional>

namespace toile::apps {

/// `limits`: what the written package is held against.
void add_garment_alter(CLI::App& garment, const GlobalOptions& global,
                       std::function<garment::PackageLimits()> limits);

} // namespace toile::apps
