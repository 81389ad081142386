// The subcommands of `toile`; each file of this folder adds its own.
#pragma once

#include "apps/global_options.h"

#include <CLI/CLI.hpp>
#include <span>

namespace toile::apps {

/// One group of subcommands each.
void add_compare_commands(CLI::App& app, const GlobalOptions& options);
void add_avatar_commands(CLI::App& app, const GlobalOptions& options);
void add_mirror_commands(CLI::App& app, const GlobalOptions& options);
void add_tryon_commands(CLI::App& app, const GlobalOptions& options);
void add_view_commands(CLI::App& app, const GlobalOptions& options);
void add_plugin_commands(CLI::App& app, const GlobalOptions& options);
void add_record_commands(CLI::App& app, const GlobalOptions& options);
void add_track_commands(CLI::App& app, const GlobalOptions& options);
void add_fit_commands(CLI::App& app, const GlobalOptions& options);
void add_scan_commands(CLI::App& app, const GlobalOptions& options);
void add_dress_commands(CLI::App& app, const GlobalOptions& options);
void add_measure_commands(CLI::App& app, const GlobalOptions& options);
void add_catalogue_commands(CLI::App& app, const GlobalOptions& options);
void add_report_commands(CLI::App& app, const GlobalOptions& options);
void add_bench_commands(CLI::App& app, const GlobalOptions& options);
void add_kiosk_commands(CLI::App& app, const GlobalOptions& global);

/// The subcommands that plugins add (toile.tool/1), in their groups; after all others. A manifest
/// whose words are taken is passed over with a warning. `words` are the program's arguments, looked
/// through for --plugins.
void add_tool_commands(CLI::App& app, const GlobalOptions& options,
                       std::span<const char* const> words);

/// toile garment list | check | new | pack
void add_garment_commands(CLI::App& app, const GlobalOptions& options);

} // namespace toile::apps
