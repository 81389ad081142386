// The real OpenNI2 library, with cameras of a driver that tests know (tests/driver), and
// recordings.
#include "core/bytes.h"
#include "imaging/oni_writer.h"
#include "openni2_sensor/tests/test_camera.h"
#include "support/ball_pictures.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cstdlib>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

namespace toile::openni2_sensor {
namespace {

using namespace test;

TEST(OpenNiSensor, TheFirstCameraGivesItsPicturesAsTheyAre) {
    OpenNiSensor sensor("", {}, log_to_heard());
    EXPECT_EQ(sensor.intrinsics().width, kWidth);
    EXPECT_EQ(sensor.intrinsics().height, kHeight);
    EXPECT_NEAR(sensor.intrinsics().field_of_view().x(), double{kAcross}, 1e-6);
    EXPECT_NEAR(sensor.intrinsics().field_of_view().y(), double{kUp}, 1e-6);
    EXPECT_TRUE(sensor.has_color());
    EXPECT_TRUE(sensor.registered());
    EXPECT_NEAR(sensor.period_s(), 1.0 / kFramesPerSecond, 1e-9);
    std::uint32_t number = 0;
    std::int64_t time_ns = -1;
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(wait_for_frame(sensor));
        const SensedFrame& frame = sensor.frame();
        EXPECT_GT(shown_number(frame), 0); // begun mirrored, as cameras are
        if (i > 0) {
            EXPECT_GT(frame.sequence, number);
        }
        EXPECT_GT(frame.timestamp_ns, time_ns);
        number = frame.sequence;
        time_ns = frame.timestamp_ns;
    }
    const SensedFrame& frame = sensor.frame();
    ASSERT_EQ(frame.color.size(), std::size_t{4 * kWidth * kHeight});
    bool any = false; // of the same picture, or of one just before
    for (int picture = 1; picture <= 7; ++picture)
        any = any || (frame.color[4 * 9 + 0] == color_at(9, 0, 0, picture) &&
                      frame.color[4 * 20 + 2] == color_at(20, 0, 2, picture));
    EXPECT_TRUE(any);
    EXPECT_TRUE(heard.empty());
}

TEST(OpenNiSensor, CamerasAreOpenedByNumberAndByUri) {
    for (const char* source : {"1", kUris[1]}) {
        OpenNiSensor sensor(source, {}, log_to_heard());
        EXPECT_TRUE(wait_for_frame(sensor)) << source;
    }
    EXPECT_ERROR(OpenNiSensor("7", {}, log_to_heard()),
                 "[1] Toile Test camera (toile-test:second)");
    EXPECT_ERROR(OpenNiSensor("usb:nowhere", {}, log_to_heard()), "no such camera");
}

TEST(OpenNiSensor, MirroredWhereWished) {
    DeviceOptions options;
    options.mirrored = true;
    OpenNiSensor sensor("", options, log_to_heard());
    ASSERT_TRUE(wait_for_frame(sensor));
    EXPECT_GT(shown_number(sensor.frame(), true), 0);
}

TEST(OpenNiSensor, GoesOnWhenItsCameraIsPluggedInAgain) {
    OpenNiSensor sensor(kUris[0], {}, log_to_heard());
    ASSERT_TRUE(wait_for_frame(sensor));
    plug(0, false);
    while (wait_for_frame(sensor, 0.2)) { // what was on its way
    }
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_NE(heard[0].find("unplugged"), std::string::npos);
    const std::uint32_t number = sensor.frame().sequence;
    const std::int64_t time_ns = sensor.frame().timestamp_ns;
    EXPECT_FALSE(wait_for_frame(sensor, 1.2)); // and nothing is said again
    EXPECT_EQ(heard.size(), 1u);
    EXPECT_FALSE(sensor.over());
    plug(0, true);
    ASSERT_TRUE(wait_for_frame(sensor));
    EXPECT_GT(shown_number(sensor.frame()), 0);
    EXPECT_GT(sensor.frame().sequence, number + 30); // those of more than a second were dropped
    EXPECT_GT(sensor.frame().timestamp_ns, time_ns + 1000000000);
    ASSERT_EQ(heard.size(), 2u);
    EXPECT_NE(heard[1].find("is back"), std::string::npos);
    plug(1, false); // the order of before, for tests that run after this one
    plug(1, true);
}

/// Pictures as the test camera's, as the engine has them.
imaging::DepthImage depth_picture(int number) {
    imaging::DepthImage out;
    out.width = kWidth;
    out.height = kHeight;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const std::uint16_t mm = depth_at(x, y, number);
            out.metres.push_back(mm == 0 ? std::numeric_limits<float>::quiet_NaN()
                                         : 0.001f * static_cast<float>(mm));
        }
    return out;
}

imaging::Image color_picture(int number) {
    imaging::Image out;
    out.width = kWidth;
    out.height = kHeight;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            for (int c = 0; c < 3; ++c)
                out.pixels.push_back(color_at(x, y, c, number));
            out.pixels.push_back(255);
        }
    return out;
}

imaging::Intrinsics camera() {
    imaging::Intrinsics out;
    out.width = kWidth;
    out.height = kHeight;
    out.fx = 70.0;
    out.fy = 71.0;
    out.cx = 0.5 * (kWidth - 1);
    out.cy = 0.5 * (kHeight - 1);
    return out;
}

constexpr int kRecorded = 12;

std::filesystem::path record(const std::filesystem::path& folder, bool color) {
    const auto file = folder / (color ? "color.oni" : "depth.oni");
    imaging::OniWriter writer(file, camera(), color, 30.0);
    for (int i = 1; i <= kRecorded; ++i) {
        const auto picture = color_picture(i);
        writer.add(5.0 + i / 30.0, depth_picture(i), color ? &picture : nullptr);
    }
    writer.finish();
    return file;
}

TEST(OniRecording, ThePlayerOfOpenNiGivesEveryPictureBitForBit) {
    const toile::test::TemporaryFolder folder;
    for (const bool color : {false, true}) {
        OpenNiSensor sensor(record(folder.path(), color), {}, log_to_heard());
        EXPECT_TRUE(heard.empty());
        EXPECT_NEAR(sensor.intrinsics().fx, 70.0, 1e-3);
        EXPECT_NEAR(sensor.intrinsics().fy, 71.0, 1e-3);
        EXPECT_EQ(sensor.has_color(), color);
        EXPECT_EQ(sensor.registered(), color);
        for (int round = 0; round < 2; ++round) {
            for (int i = 1; i <= kRecorded; ++i) {
                ASSERT_TRUE(sensor.poll()) << i;
                EXPECT_EQ(shown_number(sensor.frame()), i);
                EXPECT_EQ(sensor.frame().sequence, static_cast<std::uint32_t>(i - 1));
                EXPECT_NEAR(1e-9 * static_cast<double>(sensor.frame().timestamp_ns), (i - 1) / 30.0,
                            2e-6);
                if (color) {
                    EXPECT_EQ(sensor.frame().color, color_picture(i).pixels) << i;
                }
            }
            EXPECT_FALSE(sensor.poll());
            EXPECT_TRUE(sensor.over());
            sensor.rewind();
        }
    }
}

TEST(OniRecording, IsClosedAtOnceHoweverLittleWasPlayed) {
    const toile::test::TemporaryFolder folder;
    const auto file = record(folder.path(), true);
    for (int i = 0; i < 30; ++i) {
        auto sensor = std::make_unique<OpenNiSensor>(file, DeviceOptions{}, log_to_heard());
        for (int k = 0; k < i % 3; ++k)
            EXPECT_TRUE(sensor->poll());
        const auto began = std::chrono::steady_clock::now();
        sensor.reset();
        EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
    }
}

TEST(OniRecording, TwoPlayersOfOneFileDoNotShareItsFrames) {
    const toile::test::TemporaryFolder folder;
    const auto file = record(folder.path(), true);
    OpenNiSensor one(file, {}, log_to_heard());
    OpenNiSensor other(file, {}, log_to_heard());
    for (int i = 1; i <= kRecorded; ++i)
        for (OpenNiSensor* sensor : {&one, &other}) {
            ASSERT_TRUE(sensor->poll()) << i;
            EXPECT_EQ(shown_number(sensor->frame()), i);
        }
}

constexpr int kSampleFrames = 4;

void write_sample(const std::filesystem::path& file) {
    const auto camera = toile::test::ball_camera(32, 24);
    imaging::OniWriter writer(file, camera, true, 30.0);
    for (int k = 0; k < kSampleFrames; ++k) {
        const auto picture = toile::test::ball_color_picture(camera, k);
        writer.add(k / 30.0, toile::test::ball_depth_picture(camera, k), &picture);
    }
    writer.finish();
}

TEST(OniRecording, ThePluginsSampleIsWhatTheWriterWrites) {
    const toile::test::TemporaryFolder folder;
    write_sample(folder / "sample.oni");
    if (std::getenv("TOILE_WRITE_SAMPLES") != nullptr)
        std::filesystem::copy_file(folder / "sample.oni", TOILE_SAMPLE,
                                   std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(read_bytes(TOILE_SAMPLE, 1u << 20), read_bytes(folder / "sample.oni", 1u << 20))
        << "run this test with TOILE_WRITE_SAMPLES=1 to write the sample anew";
}

TEST(OniRecording, KeepsToItsOwnPaceWhereWished) {
    const toile::test::TemporaryFolder folder;
    DeviceOptions options;
    options.live = true;
    OpenNiSensor sensor(record(folder.path(), false), options, log_to_heard());
    const auto began = std::chrono::steady_clock::now();
    int frames = 0;
    while (!sensor.over() && std::chrono::steady_clock::now() - began < std::chrono::seconds(10)) {
        if (sensor.poll()) ++frames;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(sensor.over());
    EXPECT_GT(frames, kRecorded / 2);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    EXPECT_GT(took.count(), 0.6 * kRecorded / 30.0);
}

TEST(OniRecording, WhatIsNoRecordingIsRefused) {
    const toile::test::TemporaryFolder folder;
    EXPECT_ERROR(OpenNiSensor("nowhere.oni", {}, log_to_heard()), "there is no such recording");
    const auto text = folder.path() / "text.oni";
    std::ofstream(text) << "not a recording";
    EXPECT_ERROR(OpenNiSensor(text, {}, log_to_heard()), "is no OpenNI recording");
    const auto whole = record(folder.path(), true);
    const auto cut = folder.path() / "cut.oni";
    std::filesystem::copy_file(whole, cut);
    std::filesystem::resize_file(cut, 40);
    EXPECT_ERROR(OpenNiSensor(cut, {}, log_to_heard()), "cannot be played");
}

TEST(OniRecording, ARecordingThatBreaksOffIsPlayedUpToThere) {
    const toile::test::TemporaryFolder folder;
    const auto file = record(folder.path(), false);
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    // Its seek table is gone: OpenNI2 refuses it at once, or plays what is there.
    try {
        OpenNiSensor sensor(file, {}, log_to_heard());
        int frames = 0;
        while (sensor.poll())
            ++frames;
        EXPECT_LE(frames, kRecorded);
        EXPECT_TRUE(sensor.over());
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("cannot be played"), std::string::npos);
    }
}

} // namespace
} // namespace toile::openni2_sensor
