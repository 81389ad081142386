// `toile avatar train-space` and `toile avatar new`.
#pragma once

#include <CLI/CLI.hpp>

namespace toile::apps {

/// Adds them to the group of avatar commands.
void add_avatar_space_commands(CLI::App& group);

} // namespace toile::apps
