// Whole files: exact round trips, bounds, and one-line errors that name the file.
#include "core/bytes.h"

#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <numeric>

namespace toile {
namespace {

TEST(Bytes, EveryByteComesBack) {
    const test::TemporaryFolder folder;
    std::vector<std::uint8_t> bytes(1000);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{0}); // wraps: every value, and line ends
    write_bytes(folder / "a.bin", bytes);
    EXPECT_EQ(read_bytes(folder / "a.bin", bytes.size()), bytes);
}

TEST(Bytes, AnEmptyFileIsEmpty) {
    const test::TemporaryFolder folder;
    write_bytes(folder / "empty", {});
    EXPECT_TRUE(std::filesystem::exists(folder / "empty"));
    EXPECT_TRUE(read_bytes(folder / "empty", 0).empty());
}

TEST(Bytes, WritingReplacesALongerFile) {
    const test::TemporaryFolder folder;
    write_text(folder / "a.txt", "a long line");
    write_text(folder / "a.txt", "short");
    const auto bytes = read_bytes(folder / "a.txt", 100);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "short");
}

TEST(Bytes, WhatCannotBeReadIsNamed) {
    const test::TemporaryFolder folder;
    EXPECT_ERROR((void)read_bytes(folder / "none", 10), "none: no such file");
    EXPECT_ERROR((void)read_bytes(folder.path(), 10), "not a regular file");
    std::filesystem::create_symlink(folder / "none", folder / "dangling");
    EXPECT_ERROR((void)read_bytes(folder / "dangling", 10), "dangling: no such file");
}

TEST(Bytes, ALargerFileIsRefusedBeforeItIsRead) {
    const test::TemporaryFolder folder;
    write_text(folder / "claim", "x");
    std::filesystem::resize_file(folder / "claim", std::uintmax_t{1} << 40); // sparse: no disk
    EXPECT_ERROR((void)read_bytes(folder / "claim", 1u << 20),
                 "is 1099511627776 bytes, more than the 1048576 allowed");
}

TEST(Bytes, WhatCannotBeWrittenIsNamed) {
    const test::TemporaryFolder folder;
    EXPECT_ERROR(write_text(folder / "no/such/folder", "x"), "cannot be opened for writing");
    EXPECT_ERROR(write_text(folder.path(), "x"), "cannot be opened for writing");
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_ERROR(write_text("/dev/full", "x"), "/dev/full: cannot be written (disk full?)");
}

} // namespace
} // namespace toile
