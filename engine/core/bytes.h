// Whole files as bytes, with a bound on what is read.
#pragma once

#include "core/error.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace toile {

/// Reads a regular file whole. \throw FileError when missing, unreadable or over `max_bytes`
[[nodiscard]] std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file,
                                                   std::size_t max_bytes);

/// Writes a file whole. \throw FileError when it cannot be written
void write_bytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_text(const std::filesystem::path& file, std::string_view text);

} // namespace toile
