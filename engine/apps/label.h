// Words and patches of colour in a picture.
#pragma once

#include "imaging/image.h"

#include <array>
#include <string>

namespace toile::apps {

using Color = std::array<std::uint8_t, 3>; ///< sRGB

struct LabelStyle {
    enum class At { beginning, middle, end };
    int size = 16;         ///< pixels
    At at = At::beginning; ///< which part of the text stands at x
    Color color{33, 33, 33};
};

/// Text whose baseline lies at y, pixels. \throw Error when there is no font
void label(imaging::Image& picture, int x, int y, const std::string& text,
           const LabelStyle& style = {});

/// Fills a rectangle, cut to the picture.
void fill(imaging::Image& picture, int x, int y, int width, int height, const Color& color);

/// A disc with a smooth edge, cut to the picture.
void disc(imaging::Image& picture, float x, float y, float radius, const Color& color);

/// A white picture.
[[nodiscard]] imaging::Image blank(int width, int height);

/// Copies `from` into a picture, its top left corner at (x, y), cut to the picture.
void paste(imaging::Image& picture, const imaging::Image& from, int x, int y);

} // namespace toile::apps
