// The subcommands of `toile`; each file of this folder adds its own.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace toile::apps {

/// Options that every subcommand takes.
struct GlobalOptions {
    std::vector<std::filesystem::path> plugin_folders; ///< --plugins
    std::uint64_t seed = 1;                            ///< --seed
    std::uint32_t threads = 0;                         ///< --threads; 0: all cores
    bool verbose = false;                              ///< --verbose
};

/// One group of subcommands each.
void add_compare_commands(CLI::App& app, const GlobalOptions& options);
void add_avatar_commands(CLI::App& app, const GlobalOptions& options);
void add_mirror_commands(CLI::App& app, const GlobalOptions& options);
void add_tryon_commands(CLI::App& app, const GlobalOptions& options);
void add_view_commands(CLI::App& app, const GlobalOptions& options);
void add_plugin_commands(CLI::App& app, const GlobalOptions& options);
void add_record_commands(CLI::App& app, const GlobalOptions& options);

/// toile garment list | check | new | pack
void add_garment_commands(CLI::App& app, const GlobalOptions& options);

} // namespace toile::apps
