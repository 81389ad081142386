#include "body_tracker/grey_picture.h"

#include <algorithm>

namespace toile::body_tracker {

GreyPicture::GreyPicture(const imaging::Intrinsics& camera) : camera_(camera) {
    imaging::check_intrinsics(camera);
    const std::size_t n =
        static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    rows_.assign(n, 0);
    smooth_.assign(n, 0);
    grey_.assign(static_cast<std::size_t>(camera.width), 0);
}

void GreyPicture::take(const std::uint8_t* rgba, std::array<int, 2> low,
                       std::array<int, 2> high) noexcept {
    const int w = camera_.width;
    // Smoothing needs a pixel more on each side.
    low_ = {std::max(1, low[0]), std::max(1, low[1])};
    high_ = {std::min(w - 2, high[0]), std::min(camera_.height - 2, high[1])};
    if (rgba == nullptr || high_[0] < low_[0] || high_[1] < low_[1]) {
        low_ = {0, 0};
        high_ = {-1, -1};
        return;
    }
    for (int y = low_[1] - 1; y <= high_[1] + 1; ++y) {
        const std::uint8_t* from = rgba + 4 * static_cast<std::ptrdiff_t>(y) * w;
        for (int x = low_[0] - 1; x <= high_[0] + 1; ++x)
            grey_[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(
                (77 * from[4 * x] + 150 * from[4 * x + 1] + 29 * from[4 * x + 2]) >> 8);
        std::uint16_t* row = rows_.data() + static_cast<std::ptrdiff_t>(y) * w;
        for (int x = low_[0]; x <= high_[0]; ++x) {
            const auto i = static_cast<std::size_t>(x);
            row[x] = static_cast<std::uint16_t>(grey_[i - 1] + 2 * grey_[i] + grey_[i + 1]);
        }
    }
    for (int y = low_[1]; y <= high_[1]; ++y) {
        const std::uint16_t* row = rows_.data() + static_cast<std::ptrdiff_t>(y) * w;
        std::uint16_t* to = smooth_.data() + static_cast<std::ptrdiff_t>(y) * w;
        for (int x = low_[0]; x <= high_[0]; ++x)
            to[x] = static_cast<std::uint16_t>(row[x - w] + 2 * row[x] + row[x + w]);
    }
}

} // namespace toile::body_tracker
