#include "imaging/png_codec.h"

#include "core/error.h"

#include <csetjmp>
#include <cstring>
#include <png.h>

namespace toile::imaging {
namespace {

// Deflate packs at most about 1030 to 1, so a larger claim cannot be met by the file.
constexpr std::uint64_t kMaxRatio = 1100;

// What libpng's callbacks work on. Functions that may be left by longjmp hold no C++ objects.
struct Reader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::span<const std::uint8_t> input;
    std::size_t offset = 0;
    std::string error;

    Reader() = default;
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::vector<std::uint8_t> output;
    std::array<png_color, 256> colors{};
    std::string error;

    Writer() = default;
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { png_destroy_write_struct(&png, &info); }
};

std::size_t bytes_of(PngKind kind) {
    return kind == PngKind::rgba8 ? 4 : kind == PngKind::grey16 ? 2 : 1;
}

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = text;
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep data, std::size_t count) {
    Reader& reader = *static_cast<Reader*>(png_get_io_ptr(png));
    if (count > reader.input.size() - reader.offset) png_error(png, "the file ends too early");
    std::memcpy(data, reader.input.data() + reader.offset, count);
    reader.offset += count;
}

void on_write(png_structp png, png_bytep data, std::size_t count) {
    Writer& writer = *static_cast<Writer*>(png_get_io_ptr(png));
    writer.output.insert(writer.output.end(), data, data + count);
}

void on_flush(png_structp) {}

bool read_header(Reader& reader) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
    png_read_info(reader.png, reader.info);
    return true;
}

bool read_rows(Reader& reader, std::uint8_t* pixels, std::size_t row_bytes, PngKind kind) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
    if (kind == PngKind::rgba8) {
        png_set_expand(reader.png);
        png_set_strip_16(reader.png);
        png_set_gray_to_rgb(reader.png);
        png_set_add_alpha(reader.png, 0xff, PNG_FILLER_AFTER);
    } else if (kind == PngKind::grey16) {
        png_set_swap(reader.png);
    }
    const int passes = png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    if (png_get_rowbytes(reader.png, reader.info) != row_bytes)
        png_error(reader.png, "unexpected row size");
    const png_uint_32 height = png_get_image_height(reader.png, reader.info);
    for (int pass = 0; pass < passes; ++pass)
        for (png_uint_32 y = 0; y < height; ++y)
            png_read_row(reader.png, pixels + y * row_bytes, nullptr);
    png_read_end(reader.png, nullptr);
    return true;
}

bool write_rows(Writer& writer, const std::uint8_t* pixels, std::uint32_t width,
                std::uint32_t height, PngKind kind, PngPalette palette) {
    if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
    const bool grey = kind == PngKind::grey16, indexed = kind == PngKind::indexed8;
    png_set_IHDR(writer.png, writer.info, width, height, grey ? 16 : 8,
                 grey      ? PNG_COLOR_TYPE_GRAY
                 : indexed ? PNG_COLOR_TYPE_PALETTE
                           : PNG_COLOR_TYPE_RGBA,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(writer.png, 6);
    png_set_compression_strategy(writer.png, indexed ? 0 : 1); // Z_FILTERED
    png_set_filter(writer.png, PNG_FILTER_TYPE_BASE,
                   indexed ? PNG_FILTER_NONE : PNG_FILTER_SUB | PNG_FILTER_UP);
    if (indexed)
        png_set_PLTE(writer.png, writer.info, writer.colors.data(),
                     static_cast<int>(palette.size()));
    png_write_info(writer.png, writer.info);
    if (grey) png_set_swap(writer.png);
    const std::size_t row_bytes = std::size_t{width} * bytes_of(kind);
    for (std::uint32_t y = 0; y < height; ++y)
        png_write_row(writer.png, pixels + y * row_bytes);
    png_write_end(writer.png, nullptr);
    return true;
}

// Refuses before any memory is taken for pixels.
void check_claims(const Reader& reader, const std::string& name, int max_side, PngKind kind) {
    const std::uint64_t width = png_get_image_width(reader.png, reader.info);
    const std::uint64_t height = png_get_image_height(reader.png, reader.info);
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    const auto limit = static_cast<std::uint64_t>(max_side);
    if (width == 0 || height == 0) throw FileError(name, "an empty picture");
    if (width > limit || height > limit || width * height > kMaxPixels)
        throw FileError(name, "a picture of " + size + " pixels is larger than allowed (" +
                                  std::to_string(max_side) + " a side, " +
                                  std::to_string(kMaxPixels) + " in all)");
    const std::uint64_t packed = png_get_rowbytes(reader.png, reader.info) * height;
    if (packed / kMaxRatio > reader.input.size())
        throw FileError(name, "claims " + size + " pixels, more than its " +
                                  std::to_string(reader.input.size()) + " bytes can hold");
    if (kind == PngKind::grey16 &&
        (png_get_bit_depth(reader.png, reader.info) != 16 ||
         png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY))
        throw FileError(name, "a depth picture must be a 16-bit grey PNG");
    if (kind == PngKind::indexed8 &&
        (png_get_bit_depth(reader.png, reader.info) != 8 ||
         png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_PALETTE))
        throw FileError(name, "an indexed picture must be a PNG with a palette, a byte a pixel");
}

} // namespace

PngPixels decode_png(std::span<const std::uint8_t> bytes, const std::string& name, int max_side,
                     PngKind kind) {
    Reader reader;
    reader.input = bytes;
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader.error, on_error, on_warning);
    reader.info = png_create_info_struct(reader.png);
    if (reader.info == nullptr) throw FileError(name, "out of memory");
    png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff);
    png_set_chunk_malloc_max(reader.png, 8u << 20);
    png_set_chunk_cache_max(reader.png, 64);
    png_set_read_fn(reader.png, &reader, on_read);
    if (!read_header(reader)) throw FileError(name, "not a good PNG: " + reader.error);
    check_claims(reader, name, max_side, kind);

    PngPixels picture;
    picture.width = png_get_image_width(reader.png, reader.info);
    picture.height = png_get_image_height(reader.png, reader.info);
    const std::size_t row_bytes = std::size_t{picture.width} * bytes_of(kind);
    picture.bytes.resize(row_bytes * picture.height);
    if (!read_rows(reader, picture.bytes.data(), row_bytes, kind))
        throw FileError(name, "not a good PNG: " + reader.error);
    return picture;
}

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels, std::uint32_t width,
                                     std::uint32_t height, PngKind kind, PngPalette palette) {
    if (width == 0 || height == 0 || pixels.size() != bytes_of(kind) * width * height)
        throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                    " cannot be written from " + std::to_string(pixels.size()) + " bytes");
    if (kind == PngKind::indexed8)
        for (const std::uint8_t value : pixels)
            if (value >= palette.size() || palette.size() > 256)
                throw Error("an indexed picture has no colour for its value " +
                            std::to_string(value));
    Writer writer;
    for (std::size_t i = 0; i < palette.size(); ++i)
        writer.colors[i] = {palette[i][0], palette[i][1], palette[i][2]};
    writer.png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer.error, on_error, on_warning);
    writer.info = png_create_info_struct(writer.png);
    if (writer.info == nullptr) throw Error("out of memory while writing a PNG");
    png_set_user_limits(writer.png, 0x7fffffff, 0x7fffffff);
    png_set_write_fn(writer.png, &writer, on_write, on_flush);
    if (!write_rows(writer, pixels.data(), width, height, kind, palette))
        throw Error("a PNG cannot be written: " + writer.error);
    return std::move(writer.output);
}

} // namespace toile::imaging
