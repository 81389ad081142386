// Pictures in memory: 8-bit colour and metric depth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace toile::imaging {

/// RGBA, 8 bits a channel, rows from the top; colours are sRGB unless said otherwise.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels; ///< (width * height * 4)

    [[nodiscard]] bool empty() const { return pixels.empty(); }
};

/// Depth along the camera's axis in metres, rows from the top; NaN where unknown.
struct DepthImage {
    int width = 0;
    int height = 0;
    std::vector<float> metres; ///< (width * height)
};

/// Reads .png (any depth, expanded to RGBA8) or .jpg. \throw Error
[[nodiscard]] Image load_image(const std::filesystem::path& file, int max_side = 16384);
/// The same from a file's bytes; `name` stands for it in errors. \throw Error
[[nodiscard]] Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name,
                                 int max_side = 16384);
/// Writes .png (fixed compression settings: equal pictures give equal files) or .jpg. \throw Error
void save_image(const Image& image, const std::filesystem::path& file);
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image);

/// 16-bit PNG, millimetres by default (`scale` units a metre), 0 = unknown. \throw Error
[[nodiscard]] DepthImage load_depth(const std::filesystem::path& file, double scale = 1000.0);
/// Depths outside 1 .. 65535 units are written as unknown.
void save_depth(const DepthImage& depth, const std::filesystem::path& file, double scale = 1000.0);

} // namespace toile::imaging
