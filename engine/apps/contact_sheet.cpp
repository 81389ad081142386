#include "apps/contact_sheet.h"

#include "core/error.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <algorithm>
#include <charconv>

namespace toile::apps {

imaging::Image side_by_side(const std::vector<imaging::Image>& pictures) {
    if (pictures.empty()) throw Error("pictures side by side: there are none");
    imaging::Image out;
    out.height = pictures[0].height;
    for (const imaging::Image& p : pictures) {
        if (p.height != out.height) {
            throw Error("pictures side by side: one is " + std::to_string(p.height) +
                        " pixels high, the first " + std::to_string(out.height));
        }
        out.width += p.width;
    }
    out.pixels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) *
                      4);
    auto to = out.pixels.begin();
    for (int y = 0; y < out.height; ++y) {
        for (const imaging::Image& p : pictures) {
            const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(p.width) * 4;
            to = std::copy_n(p.pixels.begin() + y * row, row, to);
        }
    }
    return out;
}

imaging::Image shrunk(const imaging::Image& picture, int height) {
    imaging::Image out;
    out.height = height;
    out.width = std::max(1, picture.width * height / picture.height);
    out.pixels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(height) * 4);
    imaging::Image copy = picture; // OpenImageIO takes no constant pixels
    const OIIO::ImageBuf from(OIIO::ImageSpec(copy.width, copy.height, 4, OIIO::TypeDesc::UINT8),
                              copy.pixels.data());
    OIIO::ImageBuf to(OIIO::ImageSpec(out.width, out.height, 4, OIIO::TypeDesc::UINT8),
                      out.pixels.data());
    if (!OIIO::ImageBufAlgo::resize(to, from, "", 0.0f, to.roi(), 1))
        throw Error("a picture cannot be made smaller: " + to.geterror());
    return out;
}

std::pair<int, int> size_from_text(const std::string& text) {
    int width = 0;
    int height = 0;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == 'x') {
        const auto second = std::from_chars(first.ptr + 1, end, height);
        if (second.ec == std::errc() && second.ptr == end && width > 0 && height > 0) {
            return {width, height};
        }
    }
    throw UsageError("size '" + text + "' is not of the form 480x640");
}

} // namespace toile::apps
