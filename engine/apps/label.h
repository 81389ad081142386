// Words and patches of colour in a picture.
#pragma once

#include "imaging/image.h"

#include <array>
#include <string>

namespace toile::apps {

/// Dark text whose baseline begins at (x, y), pixels. \throw Error when there is no font
void label(imaging::Image& picture, int x, int y, const std::string& text, int size = 16);

/// Fills a rectangle, cut to the picture.
void fill(imaging::Image& picture, int x, int y, int width, int height,
          const std::array<std::uint8_t, 3>& color);

} // namespace toile::apps
