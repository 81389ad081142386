// Options that every subcommand takes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace toile::apps {

struct GlobalOptions {
    std::vector<std::filesystem::path> plugin_folders; ///< --plugins
    std::uint64_t seed = 1;                            ///< --seed
    std::uint32_t threads = 0;                         ///< --threads; 0: all cores
    bool verbose = false;                              ///< --verbose
};

} // namespace toile::apps
