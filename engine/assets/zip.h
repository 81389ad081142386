// Zip files from strangers, read with care; and written so that equal contents give equal files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace toile::assets {

struct ZipLimits {
    std::size_t max_file_bytes = 512u << 20; ///< of the .zip itself
    std::size_t max_entries = 2000;
    std::size_t max_entry_bytes = 256u << 20; ///< inflated, counted while inflating
    std::size_t max_total_bytes = 512u << 20; ///< the same for all entries
    std::size_t max_ratio = 200;              ///< inflated to packed, for entries over 1 MiB
};

/// Relative path with '/' -> contents, sorted.
using ZipContents = std::map<std::string, std::vector<std::uint8_t>>;

/// Reads a whole .zip into memory (folders are implied by the paths). Refused: absolute paths,
/// drive letters, backslashes, '..' and empty parts, names twice (also when only the case
/// differs), a file that is also a folder, links and other special files, encryption, methods
/// other than stored and deflate, wrong checksums, and anything over the limits.
/// \throw FileError naming the entry
[[nodiscard]] ZipContents read_zip(const std::filesystem::path& file, const ZipLimits& limits = {});

/// Reads as above and writes the files below `folder`, which is made when missing.
/// \throw Error; nothing is written when the zip is refused
void extract_zip(const std::filesystem::path& file, const std::filesystem::path& folder,
                 const ZipLimits& limits = {});

/// Writes the entries sorted, all with one fixed time and mode. \throw FileError, also for paths
/// that read_zip would refuse
void write_zip(const ZipContents& contents, const std::filesystem::path& file);

/// Why a path may not stand in a package, or "" when it may.
[[nodiscard]] std::string unsafe_path(const std::string& path);

} // namespace toile::assets
