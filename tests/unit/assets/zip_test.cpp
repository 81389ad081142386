#include "assets/zip.h"

#include "core/bytes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cstring>
#include <gtest/gtest.h>

namespace toile::assets {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) {
    return {text.begin(), text.end()};
}

// Writes a good zip, changes every occurrence of `from` in its bytes (names stand twice in a zip).
void forge(const std::filesystem::path& file, const std::string& name, const std::string& forged) {
    write_zip({{name, bytes_of("hello")}}, file);
    std::vector<std::uint8_t> bytes = read_bytes(file, 1u << 20);
    ASSERT_EQ(name.size(), forged.size());
    for (auto it = bytes.begin();;) {
        it = std::search(it, bytes.end(), name.begin(), name.end());
        if (it == bytes.end()) break;
        it = std::copy(forged.begin(), forged.end(), it);
    }
    write_bytes(file, bytes);
}

// Offset of the central directory record of the first entry.
std::size_t central(const std::vector<std::uint8_t>& bytes) {
    const std::string mark = "PK\x01\x02";
    return static_cast<std::size_t>(
        std::search(bytes.begin(), bytes.end(), mark.begin(), mark.end()) - bytes.begin());
}

TEST(Zip, RoundTripIsExactAndRepeatable) {
    const test::TemporaryFolder folder;
    const ZipContents contents = {{"garment.json", bytes_of("{}")},
                                  {"meshes/a b.glb", std::vector<std::uint8_t>(3000, 7)},
                                  {"empty.txt", {}}};
    write_zip(contents, folder / "a.zip");
    write_zip(contents, folder / "b.zip");
    EXPECT_TRUE(read_bytes(folder / "a.zip", 1u << 20) == read_bytes(folder / "b.zip", 1u << 20));
    EXPECT_TRUE(read_zip(folder / "a.zip") == contents);
    extract_zip(folder / "a.zip", folder / "out");
    EXPECT_TRUE(read_bytes(folder / "out/meshes/a b.glb", 1u << 20) ==
                contents.at("meshes/a b.glb"));
}

TEST(Zip, UnsafePathsAreRefused) {
    const test::TemporaryFolder folder;
    const auto file = folder / "a.zip";
    forge(file, "abcdefgh", "../defgh");
    EXPECT_ERROR((void)read_zip(file), "leads out of its folder");
    forge(file, "abcdefgh", "ab/../gh");
    EXPECT_ERROR((void)read_zip(file), "leads out of its folder");
    forge(file, "abcdefgh", "/bcdefgh");
    EXPECT_ERROR((void)read_zip(file), "absolute path");
    forge(file, "abcdefgh", "c:cdefgh");
    EXPECT_ERROR((void)read_zip(file), "drive letter");
    forge(file, "abcdefgh", "..\\defgh");
    EXPECT_ERROR((void)read_zip(file), "backslash");
    forge(file, "abcdefgh", "ab//efgh");
    EXPECT_ERROR((void)read_zip(file), "empty part");
    EXPECT_ERROR(write_zip({{"../x", {}}}, file), "leads out");
    EXPECT_FALSE(std::filesystem::exists(folder.path().parent_path() / "defgh"));
}

TEST(Zip, DuplicatesLinksAndEncryptionAreRefused) {
    const test::TemporaryFolder folder;
    const auto file = folder / "a.zip";
    write_zip({{"abcdefgh", bytes_of("1")}, {"ABCDEFGH", bytes_of("2")}}, file);
    EXPECT_ERROR((void)read_zip(file), "stands twice");
    write_zip({{"a", bytes_of("1")}, {"a/b", bytes_of("2")}}, file);
    EXPECT_ERROR((void)read_zip(file), "both a file and a folder");

    write_zip({{"link", bytes_of("/etc/passwd")}}, file);
    std::vector<std::uint8_t> bytes = read_bytes(file, 1u << 20);
    const std::size_t at = central(bytes);
    const std::uint32_t link = 0120777u << 16;
    std::memcpy(bytes.data() + at + 38, &link, 4);
    write_bytes(file, bytes);
    EXPECT_ERROR((void)read_zip(file), "is a link");

    write_zip({{"secret", bytes_of("hello hello hello")}}, file);
    bytes = read_bytes(file, 1u << 20);
    bytes[central(bytes) + 8] |= 1; // "encrypted" flags
    bytes[6] |= 1;
    write_bytes(file, bytes);
    EXPECT_ERROR((void)read_zip(file), "encrypted");
}

TEST(Zip, BombsAreRefused) {
    const test::TemporaryFolder folder;
    const auto file = folder / "a.zip";
    write_zip({{"bomb", std::vector<std::uint8_t>(20u << 20, 0)}}, file);
    EXPECT_LT(std::filesystem::file_size(file), 100u << 10);
    EXPECT_ERROR((void)read_zip(file), "zip bomb");
    ZipLimits limits;
    limits.max_ratio = 100000;
    limits.max_entry_bytes = 1u << 20;
    EXPECT_ERROR((void)read_zip(file, limits), "larger than allowed");
    limits.max_entry_bytes = 64u << 20;
    limits.max_total_bytes = 10u << 20;
    EXPECT_ERROR((void)read_zip(file, limits), "larger than allowed");

    // A size that lies does not help: what comes out is counted.
    std::vector<std::uint8_t> bytes = read_bytes(file, 1u << 20);
    const std::uint32_t small = 10;
    std::memcpy(bytes.data() + central(bytes) + 24, &small, 4);
    std::memcpy(bytes.data() + 22, &small, 4);
    write_bytes(file, bytes);
    EXPECT_ERROR((void)read_zip(file), "a.zip");

    ZipContents many;
    for (int i = 0; i < 50; ++i)
        many["f" + std::to_string(i)] = {};
    write_zip(many, file);
    ZipLimits few;
    few.max_entries = 49;
    EXPECT_ERROR((void)read_zip(file, few), "holds 50 entries");
    few.max_file_bytes = 100;
    EXPECT_ERROR((void)read_zip(file, few), "more than the 100 allowed");
}

TEST(Zip, DamageIsRefused) {
    const test::TemporaryFolder folder;
    const auto file = folder / "a.zip";
    write_zip({{"a", std::vector<std::uint8_t>(1000, 3)}}, file);
    std::vector<std::uint8_t> bytes = read_bytes(file, 1u << 20);
    bytes[bytes.size() / 4] ^= 0x55;
    write_bytes(file, bytes);
    EXPECT_ERROR((void)read_zip(file), "a.zip");
    bytes.resize(bytes.size() / 2);
    write_bytes(file, bytes);
    EXPECT_ERROR((void)read_zip(file), "not a good zip");
    write_bytes(file, {});
    EXPECT_ERROR((void)read_zip(file), "not a good zip");
}

} // namespace
} // namespace toile::assets
