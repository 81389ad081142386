// Recordings as they stand in the file, read back by a small reader of its own; that OpenNI2's
// player takes them is tested with openni2_sensor.
#include "imaging/oni_writer.h"

#include "core/bytes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace toile::imaging {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 5, kHeight = 4;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
constexpr std::size_t kHeaderBytes = 24, kRecordBytes = 28;

Intrinsics camera() {
    Intrinsics out;
    out.width = kWidth;
    out.height = kHeight;
    out.fx = 6.0;
    out.fy = 7.0;
    out.cx = 2.0;
    out.cy = 1.5;
    return out;
}

std::uint16_t millimetres(std::size_t pixel, int frame) {
    return static_cast<std::uint16_t>(1000 + 10 * pixel + static_cast<std::size_t>(frame));
}
DepthImage depth_of(int frame) {
    DepthImage out{kWidth, kHeight, {}};
    for (std::size_t i = 0; i < kPixels; ++i)
        out.metres.push_back(0.001f * static_cast<float>(millimetres(i, frame)));
    return out;
}
Image color_of(int frame) {
    Image out{kWidth, kHeight, {}};
    for (std::size_t i = 0; i < 4 * kPixels; ++i)
        out.pixels.push_back(i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i + 9 * frame));
    return out;
}

struct Record {
    std::uint32_t kind = 0, node = 0, fields = 0, payload = 0; // sizes in bytes
    std::uint64_t undo = 0, place = 0;
};

/// A file as the format's description has it: a header, then records to the end.
class Reader {
  public:
    explicit Reader(const fs::path& file) : bytes_(read_bytes(file, 1u << 20)) {
        std::size_t at = kHeaderBytes;
        while (at < bytes_.size()) {
            Record record;
            EXPECT_EQ(std::string(text(at), 3), "NIR") << at;
            record.place = at;
            record.kind = get<std::uint32_t>(at + 4);
            record.node = get<std::uint32_t>(at + 8);
            const auto size = get<std::uint32_t>(at + 12);
            record.payload = get<std::uint32_t>(at + 16);
            record.undo = get<std::uint64_t>(at + 20);
            if (size < kRecordBytes || at + size + record.payload > bytes_.size()) {
                ADD_FAILURE() << "a record of " << size << " bytes at " << at;
                return;
            }
            record.fields = size - static_cast<std::uint32_t>(kRecordBytes);
            records.push_back(record);
            at += size + record.payload;
        }
    }
    template <class T>
    [[nodiscard]] T get(std::size_t at) const {
        T out{};
        std::memcpy(&out, bytes_.data() + at, sizeof(T));
        return out;
    }
    [[nodiscard]] const char* text(std::size_t at) const {
        return reinterpret_cast<const char*>(bytes_.data() + at);
    }
    [[nodiscard]] std::vector<Record> of(std::uint32_t kind, std::uint32_t node) const {
        std::vector<Record> out;
        for (const Record& record : records)
            if (record.kind == kind && record.node == node) out.push_back(record);
        return out;
    }
    /// Where what follows a record's fields begins.
    static std::size_t payload(const Record& record) {
        return record.place + kRecordBytes + record.fields;
    }
    static std::size_t fields(const Record& record) { return record.place + kRecordBytes; }

    std::vector<Record> records;

  private:
    std::vector<std::uint8_t> bytes_;
};

constexpr std::uint32_t kNodeAdded = 0x0d, kNewData = 0x0a, kEnd = 0x0b, kSeekTable = 0x0e;
constexpr int kFrames = 3;

void write(const fs::path& file, bool color) {
    OniWriter writer(file, camera(), color, 30.0);
    for (int k = 0; k < kFrames; ++k) {
        const Image picture = color_of(k);
        writer.add(7.0 + 0.04 * k, depth_of(k), color ? &picture : nullptr);
    }
    EXPECT_EQ(writer.frame_count(), std::uint32_t{kFrames});
    writer.finish();
}

TEST(OniWriter, HeaderAndRecordsFillTheFile) {
    const test::TemporaryFolder folder;
    write(folder / "a.oni", true);
    const Reader file(folder / "a.oni");
    EXPECT_EQ(std::string(file.text(0), 4), "NI10");
    EXPECT_EQ(file.get<std::uint8_t>(4), 1); // version 1.0.1
    EXPECT_EQ(file.get<std::uint8_t>(5), 0);
    EXPECT_EQ(file.get<std::uint16_t>(6), 1);
    EXPECT_EQ(file.get<std::uint64_t>(12), 80'000u); // time of the last frame, microseconds
    EXPECT_EQ(file.get<std::uint32_t>(20), 1u);      // the largest node
    ASSERT_FALSE(file.records.empty());
    EXPECT_EQ(file.records.back().kind, kEnd);
    for (std::uint32_t node = 0; node < 2; ++node) {
        const auto added = file.of(kNodeAdded, node);
        ASSERT_EQ(added.size(), 1u);
        const std::size_t at = Reader::fields(added[0]);
        const std::string name = node == 0 ? "Depth" : "Image";
        ASSERT_EQ(file.get<std::uint32_t>(at), name.size() + 1);
        EXPECT_EQ(std::string(file.text(at + 4)), name);
        const std::size_t rest = at + 4 + name.size() + 1;
        EXPECT_EQ(file.get<std::uint32_t>(rest), node == 0 ? 2u : 3u);
        EXPECT_EQ(std::string(file.text(rest + 4), 4), "NONE");
        EXPECT_EQ(file.get<std::uint32_t>(rest + 8), std::uint32_t{kFrames});
        EXPECT_EQ(file.get<std::uint64_t>(rest + 12), 0u);
        EXPECT_EQ(file.get<std::uint64_t>(rest + 20), 80'000u);
        ASSERT_EQ(file.of(kSeekTable, node).size(), 1u);
        EXPECT_EQ(file.get<std::uint64_t>(rest + 28), file.of(kSeekTable, node)[0].place);
    }
}

TEST(OniWriter, EveryPixelComesBack) {
    const test::TemporaryFolder folder;
    for (const bool color : {false, true}) {
        const fs::path path = folder / (color ? "color.oni" : "depth.oni");
        write(path, color);
        const Reader file(path);
        EXPECT_EQ(file.of(kNodeAdded, 1).size(), color ? 1u : 0u);
        const auto depth = file.of(kNewData, 0);
        const auto pictures = file.of(kNewData, 1);
        ASSERT_EQ(depth.size(), std::size_t{kFrames});
        ASSERT_EQ(pictures.size(), color ? std::size_t{kFrames} : 0u);
        for (int k = 0; k < kFrames; ++k) {
            const auto n = static_cast<std::size_t>(k);
            EXPECT_EQ(depth[n].payload, 2 * kPixels);
            EXPECT_EQ(file.get<std::uint64_t>(Reader::fields(depth[n])), 40'000u * n);
            EXPECT_EQ(file.get<std::uint32_t>(Reader::fields(depth[n]) + 8), n + 1); // from 1
            for (std::size_t i = 0; i < kPixels; ++i)
                EXPECT_EQ(file.get<std::uint16_t>(Reader::payload(depth[n]) + 2 * i),
                          millimetres(i, k));
            if (!color) continue;
            EXPECT_EQ(pictures[n].payload, 3 * kPixels);
            const Image picture = color_of(k);
            for (std::size_t i = 0; i < 3 * kPixels; ++i)
                EXPECT_EQ(file.get<std::uint8_t>(Reader::payload(pictures[n]) + i),
                          picture.pixels[4 * (i / 3) + i % 3]);
        }
    }
}

TEST(OniWriter, TheIndexNamesWhereFramesStand) {
    const test::TemporaryFolder folder;
    write(folder / "a.oni", true);
    const Reader file(folder / "a.oni");
    for (std::uint32_t node = 0; node < 2; ++node) {
        const Record table = file.of(kSeekTable, node).at(0);
        const auto frames = file.of(kNewData, node);
        constexpr std::size_t kEntry = 20; // time, configuration, place
        ASSERT_EQ(table.payload, kEntry * (kFrames + 1));
        EXPECT_EQ(file.get<std::uint64_t>(Reader::payload(table) + 12), 0u); // before the first
        std::uint64_t before = 0;
        for (std::size_t k = 0; k < kFrames; ++k) {
            const std::size_t entry = Reader::payload(table) + kEntry * (k + 1);
            EXPECT_EQ(file.get<std::uint64_t>(entry), 40'000u * k);
            EXPECT_EQ(file.get<std::uint64_t>(entry + 12), frames[k].place);
            EXPECT_EQ(frames[k].undo, before); // back to the node's frame before
            before = frames[k].place;
        }
    }
}

TEST(OniWriter, DepthThatDoesNotFitHasNoReading) {
    const test::TemporaryFolder folder;
    DepthImage depth = depth_of(0);
    depth.metres[0] = std::numeric_limits<float>::quiet_NaN();
    depth.metres[1] = std::numeric_limits<float>::infinity();
    depth.metres[2] = -1.0f;
    depth.metres[3] = 65.6f;
    depth.metres[4] = 65.535f;
    depth.metres[5] = 1.2346f; // rounded to the nearest millimetre
    {
        OniWriter writer(folder / "a.oni", camera(), false, 30.0);
        writer.add(0.0, depth);
    } // finished without being asked to
    const Reader file(folder / "a.oni");
    const std::size_t at = Reader::payload(file.of(kNewData, 0).at(0));
    for (const auto& [pixel, wanted] :
         {std::pair{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 65535}, {5, 1235}})
        EXPECT_EQ(file.get<std::uint16_t>(at + 2 * static_cast<std::size_t>(pixel)), wanted);
    EXPECT_EQ(file.records.back().kind, kEnd);
}

TEST(OniWriter, WhatIsWrongIsNamed) {
    const test::TemporaryFolder folder;
    const fs::path path = folder / "a.oni";
    EXPECT_ERROR(OniWriter("/proc/nowhere/a.oni", camera(), false, 30.0),
                 "/proc/nowhere/a.oni: cannot be written");
    Intrinsics large = camera();
    large.width = 1601;
    EXPECT_ERROR(OniWriter(path, large, false, 30.0), "at most 1600 x 1200");
    EXPECT_ERROR(OniWriter(path, Intrinsics{}, false, 30.0), "");
    EXPECT_FALSE(fs::exists(path)); // nothing is begun before all is known to be right
    OniWriter writer(path, camera(), true, 30.0);
    EXPECT_ERROR(OniWriter(path, camera(), false, 30.0), "is there already");
    const Image picture = color_of(0);
    EXPECT_ERROR(writer.add(0.0, depth_of(0)), "a picture is missing");
    EXPECT_ERROR(writer.add(0.0, DepthImage{1, 1, {1.0f}}, &picture), "not of the camera's size");
    const Image other{1, 1, {0, 0, 0, 0}};
    EXPECT_ERROR(writer.add(0.0, depth_of(0), &other), "camera's size");
    writer.add(1.0, depth_of(0), &picture);
    writer.add(1.0, depth_of(1), &picture); // at once is allowed
    EXPECT_ERROR(writer.add(0.9, depth_of(2), &picture), "not in the order of their times");
    EXPECT_EQ(writer.frame_count(), 2u);
    writer.finish();
    writer.finish();
    EXPECT_ERROR(writer.add(2.0, depth_of(2), &picture), "is finished");
}

TEST(OniWriter, MakesTheFolderOfItsFile) {
    const test::TemporaryFolder folder;
    write(folder / "new/and/deeper/a.oni", false);
    EXPECT_EQ(Reader(folder / "new/and/deeper/a.oni").of(kNewData, 0).size(), std::size_t{kFrames});
}

} // namespace
} // namespace toile::imaging
