// Whether two pictures are the same up to a two-level tolerance.
#pragma once

#include "imaging/image.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace toile::apps {

/// Differences are those of a pixel's worst channel, 0 to 1 in the pictures' own (sRGB) values.
struct PictureTolerance {
    double small = 0.02;       ///< pixels may differ by this freely
    double share = 0.001;      ///< share of the pixels that may differ by more
    double largest = 0.5;      ///< no pixel may differ by more
    double warn = 2.0 / 255.0; ///< pixels beyond this are counted for a warning
};

struct PictureComparison {
    bool same_size = false;
    std::size_t pixels = 0;
    std::size_t beyond_small = 0;
    std::size_t beyond_warn = 0;
    double mean = 0.0;
    double worst = 0.0;
    int worst_x = 0; ///< pixel of the worst difference
    int worst_y = 0;
    bool equal = false; ///< within the tolerance
    std::string text;   ///< one line for people
};

/// Reads both with OpenImageIO. With `difference`, writes a picture of the differences, eight times
/// as strong (nothing when the sizes differ). \throw Error when a file cannot be read or written
[[nodiscard]] PictureComparison compare_pictures(const std::filesystem::path& a,
                                                 const std::filesystem::path& b,
                                                 const PictureTolerance& tolerance,
                                                 const std::filesystem::path& difference = {});

} // namespace toile::apps
