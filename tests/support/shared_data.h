// Real data sets that are not part of the repository; tests that use them skip where they are
// absent.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace toile::test {

/// Folder of one data set, e.g. "gltf_skins": below $TOILE_SHARED_DATA, else ../shared/data beside
/// the repository. Empty when absent.
inline std::filesystem::path shared_data(const char* set) {
    const char* root = std::getenv("TOILE_SHARED_DATA");
    const std::filesystem::path base =
        root != nullptr ? std::filesystem::path(root)
                        : std::filesystem::path(TOILE_SOURCE_DIR) / ".." / "shared" / "data";
    const auto path = base / set;
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

} // namespace toile::test

/// Defines `name` as the folder of a data set, or skips the test saying which set is missing.
#define TOILE_SHARED_DATA_OR_SKIP(name, set)                                                       \
    const std::filesystem::path name = ::toile::test::shared_data(set);                            \
    if (name.empty()) GTEST_SKIP() << "shared data set '" << (set) << "' is not here"
