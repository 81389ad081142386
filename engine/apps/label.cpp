#include "apps/label.h"

#include "core/error.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <algorithm>

namespace toile::apps {
namespace {

// Of the Debian package fonts-dejavu-core.
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

} // namespace

void label(imaging::Image& picture, int x, int y, const std::string& text, int size) {
    OIIO::ImageSpec spec(picture.width, picture.height, 4, OIIO::TypeDesc::UINT8);
    OIIO::ImageBuf buffer(spec, picture.pixels.data());
    const std::array<float, 4> dark{0.13f, 0.13f, 0.13f, 1.0f};
    if (!OIIO::ImageBufAlgo::render_text(buffer, x, y, text, size, kFont, dark))
        throw Error("words cannot be written into a picture: " + buffer.geterror() +
                    " (package fonts-dejavu-core)");
}

void fill(imaging::Image& picture, int x, int y, int width, int height,
          const std::array<std::uint8_t, 3>& color) {
    for (int row = std::max(0, y); row < std::min(picture.height, y + height); ++row)
        for (int column = std::max(0, x); column < std::min(picture.width, x + width); ++column) {
            auto* pixel = picture.pixels.data() + 4 * (static_cast<std::size_t>(row) *
                                                           static_cast<std::size_t>(picture.width) +
                                                       static_cast<std::size_t>(column));
            std::copy(color.begin(), color.end(), pixel);
        }
}

} // namespace toile::apps
