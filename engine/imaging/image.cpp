#include "imaging/image.h"

#include "core/bytes.h"
#include "imaging/png_codec.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <turbojpeg.h>

namespace toile::imaging {
namespace {

constexpr std::size_t kMaxFileBytes = 256u << 20;
constexpr int kJpegQuality = 92;

struct JpegDeleter {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using JpegHandle = std::unique_ptr<void, JpegDeleter>;

bool starts_with(std::span<const std::uint8_t> bytes, std::initializer_list<int> magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](int m, std::uint8_t b) { return m == static_cast<int>(b); });
}

Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name, int max_side) {
    const JpegHandle handle(tjInitDecompress());
    if (!handle) throw FileError(name, "the JPEG decoder does not start");
    int width = 0;
    int height = 0;
    int sampling = 0;
    int space = 0;
    const auto size = static_cast<unsigned long>(bytes.size());
    if (tjDecompressHeader3(handle.get(), bytes.data(), size, &width, &height, &sampling, &space) !=
        0)
        throw FileError(name, std::string("not a good JPEG: ") + tjGetErrorStr2(handle.get()));
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (width <= 0 || height <= 0 || width > max_side || height > max_side || pixels > kMaxPixels)
        throw FileError(name, "a picture of " + std::to_string(width) + " x " +
                                  std::to_string(height) + " pixels is larger than allowed (" +
                                  std::to_string(max_side) + " a side)");
    Image image{width, height, std::vector<std::uint8_t>(pixels * 4)};
    if (tjDecompress2(handle.get(), bytes.data(), size, image.pixels.data(), width, 0, height,
                      TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0)
        throw FileError(name, std::string("not a good JPEG: ") + tjGetErrorStr2(handle.get()));
    return image;
}

std::vector<std::uint8_t> encode_jpeg(const Image& image) {
    const JpegHandle handle(tjInitCompress());
    unsigned char* data = nullptr;
    unsigned long size = 0;
    const int status =
        handle ? tjCompress2(handle.get(), image.pixels.data(), image.width, 0, image.height,
                             TJPF_RGBA, &data, &size, TJSAMP_444, kJpegQuality, TJFLAG_ACCURATEDCT)
               : -1;
    const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(data, tjFree);
    if (status != 0) throw Error(std::string("a JPEG cannot be written: ") + tjGetErrorStr());
    return {data, data + size};
}

void require_whole(const Image& image, const std::string& file) {
    const auto expected = 4 * static_cast<std::size_t>(std::max(image.width, 0)) *
                          static_cast<std::size_t>(std::max(image.height, 0));
    if (expected == 0 || image.pixels.size() != expected)
        throw FileError(file, "an empty or incomplete picture cannot be written");
}

} // namespace

Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name, int max_side) {
    if (starts_with(bytes, {0x89, 'P', 'N', 'G'})) {
        PngPixels png = decode_png(bytes, name, max_side, PngKind::rgba8);
        return {static_cast<int>(png.width), static_cast<int>(png.height), std::move(png.bytes)};
    }
    if (starts_with(bytes, {0xff, 0xd8, 0xff})) return decode_jpeg(bytes, name, max_side);
    throw FileError(name, "neither a PNG nor a JPEG picture");
}

Image load_image(const std::filesystem::path& file, int max_side) {
    return decode_image(read_bytes(file, kMaxFileBytes), file.string(), max_side);
}

std::vector<std::uint8_t> encode_png(const Image& image) {
    return encode_png(image.pixels, static_cast<std::uint32_t>(std::max(image.width, 0)),
                      static_cast<std::uint32_t>(std::max(image.height, 0)), PngKind::rgba8);
}

void save_image(const Image& image, const std::filesystem::path& file) {
    require_whole(image, file.string());
    const std::string extension = file.extension().string();
    if (extension == ".png")
        write_bytes(file, encode_png(image));
    else if (extension == ".jpg" || extension == ".jpeg")
        write_bytes(file, encode_jpeg(image));
    else
        throw FileError(file.string(), "pictures are written as .png or .jpg");
}

DepthImage load_depth(const std::filesystem::path& file, double scale) {
    if (!(scale > 0.0)) throw FileError(file.string(), "the depth scale must be positive");
    const PngPixels png =
        decode_png(read_bytes(file, kMaxFileBytes), file.string(), 16384, PngKind::grey16);
    DepthImage depth{static_cast<int>(png.width), static_cast<int>(png.height), {}};
    depth.metres.resize(png.bytes.size() / 2);
    for (std::size_t i = 0; i < depth.metres.size(); ++i) {
        std::uint16_t value = 0;
        std::memcpy(&value, png.bytes.data() + 2 * i, 2);
        depth.metres[i] = value == 0 ? std::numeric_limits<float>::quiet_NaN()
                                     : static_cast<float>(value / scale);
    }
    return depth;
}

void save_depth(const DepthImage& depth, const std::filesystem::path& file, double scale) {
    std::vector<std::uint8_t> bytes(2 * depth.metres.size(), 0);
    for (std::size_t i = 0; i < depth.metres.size(); ++i) {
        const double units = std::round(static_cast<double>(depth.metres[i]) * scale);
        if (!(units >= 1.0 && units <= 65535.0)) continue; // stays 0: unknown
        const auto value = static_cast<std::uint16_t>(units);
        std::memcpy(bytes.data() + 2 * i, &value, 2);
    }
    write_bytes(file,
                encode_png(bytes, static_cast<std::uint32_t>(std::max(depth.width, 0)),
                           static_cast<std::uint32_t>(std::max(depth.height, 0)), PngKind::grey16));
}

} // namespace toile::imaging
