#include "apps/label.h"

#include "core/error.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <algorithm>
#include <cmath>

namespace toile::apps {
namespace {

// Of the Debian package fonts-dejavu-core.
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

std::uint8_t* pixel_at(imaging::Image& picture, int x, int y) {
    return picture.pixels.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                static_cast<std::size_t>(x));
}

} // namespace

void label(imaging::Image& picture, int x, int y, const std::string& text,
           const LabelStyle& style) {
    using OIIO::ImageBufAlgo::TextAlignX;
    const OIIO::ImageSpec spec(picture.width, picture.height, 4, OIIO::TypeDesc::UINT8);
    OIIO::ImageBuf buffer(spec, picture.pixels.data());
    std::array<float, 4> color{0.0f, 0.0f, 0.0f, 1.0f};
    for (std::size_t c = 0; c < style.color.size(); ++c)
        color[c] = static_cast<float>(style.color[c]) / 255.0f;
    const TextAlignX align = style.at == LabelStyle::At::middle ? TextAlignX::Center
                             : style.at == LabelStyle::At::end  ? TextAlignX::Right
                                                                : TextAlignX::Left;
    if (!OIIO::ImageBufAlgo::render_text(buffer, x, y, text, style.size, kFont, color, align))
        throw Error("words cannot be written into a picture: " + buffer.geterror() +
                    " (package fonts-dejavu-core)");
}

void fill(imaging::Image& picture, int x, int y, int width, int height, const Color& color) {
    for (int row = std::max(0, y); row < std::min(picture.height, y + height); ++row)
        for (int column = std::max(0, x); column < std::min(picture.width, x + width); ++column)
            std::copy(color.begin(), color.end(), pixel_at(picture, column, row));
}

void disc(imaging::Image& picture, float x, float y, float radius, const Color& color) {
    const int reach = static_cast<int>(std::ceil(radius)) + 1;
    const int left = static_cast<int>(std::lround(x)) - reach;
    const int top = static_cast<int>(std::lround(y)) - reach;
    for (int row = std::max(0, top); row < std::min(picture.height, top + 2 * reach + 1); ++row)
        for (int column = std::max(0, left); column < std::min(picture.width, left + 2 * reach + 1);
             ++column) {
            const float distance =
                std::hypot(static_cast<float>(column) - x, static_cast<float>(row) - y);
            const float share = std::clamp(radius + 0.5f - distance, 0.0f, 1.0f);
            std::uint8_t* pixel = pixel_at(picture, column, row);
            for (std::size_t c = 0; c < color.size(); ++c)
                pixel[c] = static_cast<std::uint8_t>(
                    std::lround(share * static_cast<float>(color[c]) +
                                (1.0f - share) * static_cast<float>(pixel[c])));
        }
}

imaging::Image blank(int width, int height) {
    imaging::Image out;
    out.width = width;
    out.height = height;
    out.pixels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 255);
    return out;
}

void paste(imaging::Image& picture, const imaging::Image& from, int x, int y) {
    const int first = std::max(0, -x), last = std::min(from.width, picture.width - x);
    if (first >= last) return;
    for (int row = std::max(0, -y); row < std::min(from.height, picture.height - y); ++row)
        std::copy_n(from.pixels.data() +
                        4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(from.width) +
                             static_cast<std::size_t>(first)),
                    4 * static_cast<std::size_t>(last - first),
                    pixel_at(picture, x + first, y + row));
}

} // namespace toile::apps
