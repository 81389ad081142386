#include "imaging/indexed_image.h"

#include "core/bytes.h"
#include "imaging/png_codec.h"

#include <algorithm>

namespace toile::imaging {
namespace {

constexpr std::size_t kMaxFileBytes = 256u << 20;

} // namespace

IndexedImage load_indexed(const std::filesystem::path& file) {
    PngPixels png =
        decode_png(read_bytes(file, kMaxFileBytes), file.string(), 16384, PngKind::indexed8);
    return {static_cast<int>(png.width), static_cast<int>(png.height), std::move(png.bytes), {}};
}

void save_indexed(const IndexedImage& image, const std::filesystem::path& file) {
    write_bytes(file, encode_png(image.values, static_cast<std::uint32_t>(std::max(image.width, 0)),
                                 static_cast<std::uint32_t>(std::max(image.height, 0)),
                                 PngKind::indexed8, image.colors));
}

} // namespace toile::imaging
