// A package's files: a folder in place, or a zip unpacked for as long as this object lives.
#pragma once

#include "garment/fault.h"
#include "garment/package.h"

#include <filesystem>
#include <string>
#include <vector>

namespace toile::garment {

class PackageFiles {
  public:
    /// \throw PackageError when there is no such package or the zip is unfit
    PackageFiles(const std::filesystem::path& folder_or_zip, const PackageLimits& limits);
    ~PackageFiles();
    PackageFiles(const PackageFiles&) = delete;
    PackageFiles& operator=(const PackageFiles&) = delete;

    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    /// How a file of the package is called in texts: "t-shirt.zip/M.glb".
    [[nodiscard]] std::string shown(const std::string& relative) const;
    /// The file on disk. `named_by` is the file that asks for it.
    /// \throw PackageError when unsafe, missing or too large
    [[nodiscard]] std::filesystem::path resolve(const std::string& relative,
                                                const std::string& named_by) const;

  private:
    void unpack();

    std::filesystem::path source_;
    std::filesystem::path root_;
    bool temporary_ = false;
    PackageLimits limits_;
};

/// Files that a .glb or .obj names (buffers, textures, material libraries and their textures),
/// relative to the package. \throw PackageError when one is unsafe, missing or unreadable
[[nodiscard]] std::vector<std::string> referenced_files(const PackageFiles& files,
                                                        const std::string& mesh);

} // namespace toile::garment
