// `toile garment draft`: a garment package from a sewing pattern.
#pragma once

#include "garment/package.h"

#include <CLI/CLI.hpp>
#include <functional>

namespace toile::apps {

void add_garment_draft(CLI::App& garment, std::function<garment::PackageLimits()> package_limits);

} // namespace toile::apps
