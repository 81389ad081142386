// MakeHuman's CC0 release as one folder: the shared data set keeps most targets in an archive.
#pragma once

#include "support/run_program.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

#include <filesystem>
#include <memory>

namespace toile::test {

/// The release with all targets, unpacked once a program; empty when the data set is not here.
inline std::filesystem::path makehuman_release() {
    static const std::unique_ptr<TemporaryFolder> folder =
        []() -> std::unique_ptr<TemporaryFolder> {
        const std::filesystem::path from = shared_data("makehuman_cc0");
        if (from.empty()) return nullptr;
        auto made = std::make_unique<TemporaryFolder>();
        std::filesystem::create_directory_symlink(std::filesystem::absolute(from / "makehuman"),
                                                  *made / "makehuman");
        const auto unpacked = run_program(
            {"tar", "-xJf", (from / "targets.tar.xz").string(), "-C", made->path().string()});
        return unpacked.status == 0 ? std::move(made) : nullptr;
    }();
    return folder ? folder->path() : std::filesystem::path();
}

} // namespace toile::test
