// Pictures of small whole numbers: which part, which thing, each pixel shows.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace toile::imaging {

/// A small whole number for each pixel, with a colour to look at it by.
struct IndexedImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> values;                ///< (width * height) rows from the top
    std::vector<std::array<std::uint8_t, 3>> colors; ///< sRGB of each value, 256 at most
};

/// PNG with a palette. `load_indexed` leaves the colours out. \throw Error
void save_indexed(const IndexedImage& image, const std::filesystem::path& file);
[[nodiscard]] IndexedImage load_indexed(const std::filesystem::path& file);

} // namespace toile::imaging
