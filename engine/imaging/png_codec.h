// libpng with bounded input: sizes are refused before memory is taken for them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace toile::imaging {

/// Most pixels of any picture read; a decoder never allocates for more.
inline constexpr std::uint64_t kMaxPixels = 1ull << 26;

struct PngPixels {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> bytes; ///< rows from the top, RGBA8, or 16-bit grey in host order
};

enum class PngKind { rgba8, grey16, indexed8 };

/// Of an indexed picture: sRGB of its values from 0, at most 256.
using PngPalette = std::span<const std::array<std::uint8_t, 3>>;

/// `grey16` takes only 16-bit grey files, `indexed8` only such of a byte a pixel (and leaves
/// the values); `rgba8` expands everything. \throw FileError
[[nodiscard]] PngPixels decode_png(std::span<const std::uint8_t> bytes, const std::string& name,
                                   int max_side, PngKind kind);

/// `pixels` as PngPixels::bytes; `palette` of an indexed picture. \throw Error
[[nodiscard]] std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels,
                                                   std::uint32_t width, std::uint32_t height,
                                                   PngKind kind, PngPalette palette = {});

} // namespace toile::imaging
