#include "imaging/image.h"

#include "core/bytes.h"
#include "core/random.h"
#include "imaging/indexed_image.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace toile::imaging {
namespace {

Image noise(int width, int height, std::uint64_t seed) {
    Image image{width, height, {}};
    Random random(seed);
    for (int i = 0; i < 4 * width * height; ++i)
        image.pixels.push_back(static_cast<std::uint8_t>(random.next()));
    return image;
}

void set_big_endian(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i)
        bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

// The header chunk starts at byte 12 ("IHDR") and its checksum follows 17 bytes on.
void claim_size(std::vector<std::uint8_t>& png, std::uint32_t width, std::uint32_t height) {
    set_big_endian(png, 16, width);
    set_big_endian(png, 20, height);
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 12; i < 29; ++i) {
        crc ^= png[i];
        for (int k = 0; k < 8; ++k)
            crc = (crc >> 1) ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    set_big_endian(png, 29, ~crc);
}

TEST(Png, RoundTripIsExactAndRepeatable) {
    const test::TemporaryFolder folder;
    const Image image = noise(37, 19, 1);
    save_image(image, folder / "a.png");
    const Image back = load_image(folder / "a.png");
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 19);
    EXPECT_EQ(back.pixels, image.pixels);
    EXPECT_EQ(encode_png(image), encode_png(back));
}

TEST(Jpeg, RoundTripIsClose) {
    const test::TemporaryFolder folder;
    Image image{64, 48, {}};
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            for (const int value : {x * 4, y * 5, 128, 255})
                image.pixels.push_back(static_cast<std::uint8_t>(value));
    save_image(image, folder / "a.jpg");
    const Image back = load_image(folder / "a.jpg");
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_NEAR(image.pixels[i], back.pixels[i], 8);
}

TEST(Depth, MillimetresRoundTripAndUnknownStaysUnknown) {
    const test::TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const DepthImage depth{3, 2, {0.5f, nan, 2.6004f, 65.535f, 70.0f, -1.0f}};
    save_depth(depth, folder / "d.png");
    const DepthImage back = load_depth(folder / "d.png");
    ASSERT_EQ(back.metres.size(), 6u);
    EXPECT_FLOAT_EQ(back.metres[0], 0.5f);
    EXPECT_TRUE(std::isnan(back.metres[1]));
    EXPECT_FLOAT_EQ(back.metres[2], 2.6f);
    EXPECT_FLOAT_EQ(back.metres[3], 65.535f);
    EXPECT_TRUE(std::isnan(back.metres[4]));
    EXPECT_TRUE(std::isnan(back.metres[5]));
}

TEST(Depth, AColourPictureIsRefused) {
    const test::TemporaryFolder folder;
    save_image(noise(4, 4, 2), folder / "c.png");
    EXPECT_ERROR((void)load_depth(folder / "c.png"), "16-bit grey");
}

TEST(Refusals, HostileSizes) {
    std::vector<std::uint8_t> png = encode_png(noise(4, 4, 3));
    claim_size(png, 8000, 8000);
    EXPECT_ERROR((void)decode_image(png, "x.png"), "more than its");
    claim_size(png, 60000, 60000);
    EXPECT_ERROR((void)decode_image(png, "x.png"), "larger than allowed");
    claim_size(png, 0x7fffffff, 0x7fffffff);
    EXPECT_ERROR((void)decode_image(png, "x.png"), "larger than allowed");
    EXPECT_ERROR((void)decode_image(encode_png(noise(65, 4, 4)), "x.png", 64),
                 "larger than allowed");
}

TEST(Refusals, BrokenFiles) {
    const test::TemporaryFolder folder;
    std::vector<std::uint8_t> png = encode_png(noise(16, 16, 5));
    png.resize(png.size() / 2);
    EXPECT_ERROR((void)decode_image(png, "x.png"), "x.png: not a good PNG");
    EXPECT_ERROR((void)decode_image({}, "x.png"), "neither a PNG nor a JPEG");
    EXPECT_ERROR((void)load_image(folder / "none.png"), "no such file");
    EXPECT_ERROR((void)load_image(folder.path()), "not a regular file");

    save_image(noise(64, 64, 6), folder / "a.jpg");
    std::vector<std::uint8_t> jpeg = read_bytes(folder / "a.jpg", 1u << 20);
    jpeg.resize(jpeg.size() / 2);
    EXPECT_ERROR((void)decode_image(jpeg, "x.jpg"), "x.jpg: not a good JPEG");
    EXPECT_ERROR(save_image(noise(4, 4, 7), folder / "a.tiff"), ".png or .jpg");
    EXPECT_ERROR(save_image(Image{4, 4, {}}, folder / "a.png"), "incomplete");
}

TEST(Image, IndexedPicturesKeepTheirValues) {
    const test::TemporaryFolder folder;
    IndexedImage image{3, 2, {0, 1, 2, 2, 1, 0}, {{0, 0, 0}, {255, 10, 20}, {30, 40, 250}}};
    save_indexed(image, folder / "parts.png");
    const IndexedImage read = load_indexed(folder / "parts.png");
    EXPECT_EQ(read.width, 3);
    EXPECT_EQ(read.height, 2);
    EXPECT_EQ(read.values, image.values);
    // Any viewer sees the colours.
    const Image seen = load_image(folder / "parts.png");
    EXPECT_EQ(seen.pixels[4], 255);
    EXPECT_EQ(seen.pixels[5], 10);
    EXPECT_EQ(seen.pixels[4 * 2 + 2], 250);
    image.values[0] = 3;
    EXPECT_THROW(save_indexed(image, folder / "parts.png"), Error);
    save_image(seen, folder / "colors.png");
    EXPECT_THROW((void)load_indexed(folder / "colors.png"), Error);
}

} // namespace
} // namespace toile::imaging
