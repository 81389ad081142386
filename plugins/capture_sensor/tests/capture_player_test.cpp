// Capture folders as cameras: every frame in turn, or the newest that is due.
#define TOILE_STATIC_PLUGIN
#include "capture_sensor/capture_player.h"
#include "host/contract.h"
#include "host/instance.h"
#include "host/views.h"
#include "support/ball_pictures.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>

extern "C" const toile_entry toile_plugin_entry_capture_sensor;

namespace toile::capture_sensor {
namespace {

imaging::Intrinsics small_camera() {
    imaging::Intrinsics out;
    out.width = 4;
    out.height = 3;
    out.fx = out.fy = 5.0;
    out.cx = 1.5;
    out.cy = 1.0;
    return out;
}

/// Frames 0.1 s apart; frame k has depth 1 + k metres, and one unknown pixel.
void write_camera(const std::filesystem::path& folder, int frames, double begin_s, bool color,
                  bool posed) {
    std::optional<Eigen::Isometry3d> pose;
    if (posed) pose = Eigen::Isometry3d(Eigen::Translation3d(1.0, 2.0, 3.0));
    imaging::CaptureWriter writer(folder, small_camera(), pose);
    imaging::Image picture{4, 3, std::vector<std::uint8_t>(48, 200)};
    for (int k = 0; k < frames; ++k) {
        imaging::DepthImage depth{4, 3, std::vector<float>(12, 1.0f + static_cast<float>(k))};
        depth.metres[5] = std::numeric_limits<float>::quiet_NaN();
        writer.add(begin_s + 0.1 * k, depth, color ? &picture : nullptr);
    }
}

TEST(CapturePlayer, GivesEveryFrameInTurn) {
    const test::TemporaryFolder folder;
    write_camera(folder / "a", 3, 10.0, true, true);
    write_camera(folder / "b", 2, 10.05, false, false);
    CapturePlayer player(folder.path());
    ASSERT_EQ(player.capture().cameras.size(), 2u);
    EXPECT_NEAR(player.period(0), 0.1, 1e-9);
    EXPECT_TRUE(player.has_color(0));
    EXPECT_FALSE(player.has_color(1));
    for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(player.advance(0), CapturePlayer::Step::frame);
        EXPECT_EQ(player.frame(0).sequence, static_cast<std::uint32_t>(k));
        EXPECT_NEAR(1e-9 * static_cast<double>(player.frame(0).timestamp_ns), 0.1 * k, 1e-6);
        EXPECT_FLOAT_EQ(player.frame(0).depth.metres[0], 1.0f + static_cast<float>(k));
        EXPECT_TRUE(std::isnan(player.frame(0).depth.metres[5]));
        EXPECT_FALSE(player.frame(0).color.empty());
    }
    EXPECT_EQ(player.advance(0), CapturePlayer::Step::over);
    EXPECT_EQ(player.advance(0), CapturePlayer::Step::over);
    ASSERT_EQ(player.advance(1), CapturePlayer::Step::frame); // streams do not wait
    EXPECT_NEAR(1e-9 * static_cast<double>(player.frame(1).timestamp_ns), 0.05, 1e-6);
    EXPECT_TRUE(player.frame(1).color.empty());
    player.rewind();
    ASSERT_EQ(player.advance(0), CapturePlayer::Step::frame);
    EXPECT_EQ(player.frame(0).sequence, 0u);
}

TEST(CapturePlayer, ByTheClockLateFramesAreLeftOut) {
    const test::TemporaryFolder folder;
    write_camera(folder.path() / "a", 5, 3.0, false, false);
    CapturePlayer player(folder / "a");
    EXPECT_EQ(player.advance(0, 0.0), CapturePlayer::Step::frame);
    EXPECT_EQ(player.advance(0, 0.05), CapturePlayer::Step::nothing_new);
    EXPECT_EQ(player.advance(0, 0.35), CapturePlayer::Step::frame);
    EXPECT_EQ(player.frame(0).sequence, 3u); // 1 and 2 were late
    EXPECT_EQ(player.advance(0, 9.0), CapturePlayer::Step::frame);
    EXPECT_EQ(player.frame(0).sequence, 4u);
    EXPECT_EQ(player.advance(0, 9.0), CapturePlayer::Step::over);
}

TEST(CapturePlayer, WhatIsWrongIsNamed) {
    const test::TemporaryFolder folder;
    EXPECT_ERROR(CapturePlayer(folder / "none"), "none");
    EXPECT_ERROR(CapturePlayer{folder.path()}, "intrinsic.json");
    write_camera(folder / "empty", 0, 0.0, false, false);
    EXPECT_ERROR(CapturePlayer(folder / "empty"), "no frames");
    write_camera(folder / "bad", 2, 0.0, false, false);
    std::ofstream(folder / "bad/depth/000000.png") << "no picture";
    CapturePlayer player(folder / "bad");
    EXPECT_ERROR((void)player.advance(0), "000000.png");
    EXPECT_EQ(player.advance(0), CapturePlayer::Step::frame); // the next one is good
}

constexpr int kSampleFrames = 4;

void write_sample(const std::filesystem::path& folder) {
    const auto camera = test::ball_camera(64, 48);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Vec3d(0.0, 1.0, 2.0);
    imaging::CaptureWriter writer(folder, camera, pose);
    for (int k = 0; k < kSampleFrames; ++k) {
        const auto picture = test::ball_color_picture(camera, k);
        writer.add(k / 30.0, test::ball_depth_picture(camera, k), &picture);
    }
}

TEST(CapturePlayer, ThePluginsSampleIsWhatTheWriterWrites) {
    if (std::getenv("TOILE_WRITE_SAMPLES") != nullptr) {
        std::filesystem::remove_all(TOILE_SAMPLE);
        write_sample(TOILE_SAMPLE);
    }
    CapturePlayer player(TOILE_SAMPLE);
    const auto camera = test::ball_camera(64, 48);
    for (int k = 0; k < kSampleFrames; ++k) {
        ASSERT_EQ(player.advance(0), CapturePlayer::Step::frame);
        const auto wanted = test::ball_depth_picture(camera, k);
        ASSERT_EQ(player.frame(0).depth.metres.size(), wanted.metres.size());
        for (std::size_t i = 0; i < wanted.metres.size(); ++i) {
            const float metres = player.frame(0).depth.metres[i];
            EXPECT_TRUE(std::isnan(wanted.metres[i]) ? std::isnan(metres)
                                                     : metres == wanted.metres[i])
                << "run this test with TOILE_WRITE_SAMPLES=1 to write the sample anew";
        }
        EXPECT_EQ(player.frame(0).color.width, 64);
    }
    EXPECT_EQ(player.advance(0), CapturePlayer::Step::over);
}

/// The plugin as the host sees it, with another sample than its own: two cameras.
host::Manifest manifest(const std::filesystem::path& sample) {
    host::Manifest out;
    out.id = "toile.capture_sensor";
    out.version = "0.1.0";
    out.provides = {TOILE_SENSOR};
    out.schemes = {"capture"};
    out.sample = sample;
    return out;
}

TEST(CaptureSensor, KeepsTheRulesOfItsKindOnARecording) {
    const test::TemporaryFolder folder;
    write_camera(folder / "a", 3, 10.0, true, true);
    write_camera(folder / "b", 3, 10.0, false, false);
    const auto plugin =
        host::Plugin::link(toile_plugin_entry_capture_sensor, manifest(folder.path()));
    for (const host::ContractCase& rule : host::contract_cases())
        if (host::applies(rule, plugin->manifest())) {
            EXPECT_NO_THROW(host::run_contract_case(rule, plugin)) << rule.name;
        }
}

/// A recording with a fault in its second frame, and what the plugin says of it.
class BadRecordings : public ::testing::Test {
  protected:
    void write() {
        std::filesystem::remove_all(capture());
        write_camera(capture(), 3, 10.0, true, false);
    }
    [[nodiscard]] std::filesystem::path capture() const { return folder_ / "a"; }

    /// Every poll to the end: numbers of the frames that came; texts of errors.
    struct Played {
        std::vector<std::uint32_t> frames;
        std::vector<std::string> errors;
    };
    Played play(const std::function<void()>& after_open = [] {}) {
        Played out;
        host::Services services(1);
        host::Instance instance(
            host::Plugin::link(toile_plugin_entry_capture_sensor, manifest(capture())), services);
        auto limits = host::sized<toile_limits>();
        limits.thread_count = 1;
        instance.activate(limits);
        const auto& table = instance.table<toile_sensor>();
        if (table.open(instance.handle(), capture().c_str(), nullptr) != TOILE_OK) {
            out.errors.push_back(instance.take_error());
            return out;
        }
        after_open();
        for (int i = 0; i < 10; ++i) {
            auto frame = host::sized<toile_frame>();
            const toile_status status = table.poll(instance.handle(), 0, &frame);
            if (status == TOILE_END_OF_STREAM) break;
            if (status < 0) out.errors.push_back(instance.take_error());
            if (status != TOILE_OK) continue;
            EXPECT_EQ(frame.depth_m.count, 12u);
            out.frames.push_back(frame.sequence);
            table.release(instance.handle(), &frame);
        }
        return out;
    }
    /// It opens, the second frame is an error that holds `part`, the others come.
    void expect_frame_error(const std::string& part, const Played& played) {
        EXPECT_EQ(played.frames, (std::vector<std::uint32_t>{0, 2})) << part;
        ASSERT_EQ(played.errors.size(), 1u) << part;
        EXPECT_NE(played.errors[0].find(part), std::string::npos) << played.errors[0];
        EXPECT_NE(played.errors[0].find("000001."), std::string::npos) << played.errors[0];
    }
    /// It does not open.
    void expect_refused(const std::string& part) {
        const Played played = play();
        ASSERT_EQ(played.errors.size(), 1u) << part;
        EXPECT_NE(played.errors[0].find(part), std::string::npos) << played.errors[0];
    }
    void write_times(const std::string& text) {
        std::ofstream(capture() / "timestamps.csv") << text;
    }

    const test::TemporaryFolder folder_;
};

TEST_F(BadRecordings, APictureThatCannotBeUsedIsAnErrorOfItsFrame) {
    write();
    EXPECT_EQ(play().frames.size(), 3u);
    imaging::save_depth({3, 2, std::vector<float>(6, 1.0f)}, capture() / "depth/000001.png");
    expect_frame_error("is 3 x 2 pixels, the camera 4 x 3", play());
    write();
    imaging::save_image({4, 3, std::vector<std::uint8_t>(48, 9)}, capture() / "depth/000001.png");
    expect_frame_error("depth/000001.png", play()); // eight bits
    write();
    std::filesystem::resize_file(capture() / "depth/000001.png", 60);
    expect_frame_error("depth/000001.png", play());
    write();
    std::filesystem::resize_file(capture() / "color/000001.jpg", 60);
    expect_frame_error("color/000001.jpg", play());
    write();
    imaging::save_image({2, 2, std::vector<std::uint8_t>(16, 9)}, capture() / "color/000001.jpg");
    expect_frame_error("is 2 x 2 pixels, the camera 4 x 3", play());
    write();
    const auto taken_away = [&] { std::filesystem::remove(capture() / "depth/000001.png"); };
    expect_frame_error("depth/000001.png", play(taken_away)); // while it plays
}

TEST_F(BadRecordings, FramesWithoutAnythingSeenAreFrames) {
    write();
    imaging::save_depth({4, 3, std::vector<float>(12, std::numeric_limits<float>::quiet_NaN())},
                        capture() / "depth/000001.png");
    EXPECT_EQ(play().frames.size(), 3u);
}

TEST_F(BadRecordings, AMissingFrameIsAGapOrAnError) {
    write();
    std::filesystem::remove(capture() / "depth/000001.png");
    expect_refused("no picture for frame 1"); // the times tell of it
    std::filesystem::remove(capture() / "color/000001.jpg");
    std::filesystem::remove(capture() / "timestamps.csv");
    const Played played = play();
    EXPECT_TRUE(played.errors.empty());
    EXPECT_EQ(played.frames, (std::vector<std::uint32_t>{0, 2}));
}

TEST_F(BadRecordings, TimesThatDoNotRiseAreRefusedByLine) {
    write();
    write_times("0,10.0\n1,10.1\n2,10.1\n");
    expect_refused("timestamps.csv: line 3: times do not rise");
    write_times("0,10.0\n1,10.2\n2,10.1\n");
    expect_refused("timestamps.csv: line 3: times do not rise");
    write_times("0,10.0\n2,10.1\n1,10.2\n"); // frames out of order
    expect_refused("timestamps.csv: times do not rise with the frames");
    write_times("0,10.0\n1,10.1\n1,10.2\n");
    expect_refused("timestamps.csv: line 3: the frame stands twice");
    write_times("0,10.0\n1,10.1\n");
    expect_refused("timestamps.csv: has no time for frame 2");
}

TEST(CaptureSensor, TellsCalibrationAndPose) {
    const test::TemporaryFolder folder;
    write_camera(folder / "a", 1, 0.0, true, true);
    write_camera(folder / "b", 1, 0.0, false, false);
    host::Services services(1);
    host::Instance instance(
        host::Plugin::link(toile_plugin_entry_capture_sensor, manifest(folder.path())), services);
    auto limits = host::sized<toile_limits>();
    limits.thread_count = 1;
    instance.activate(limits);
    const auto& table = instance.table<toile_sensor>();
    instance.call("open",
                  [&](toile_instance* i) { return table.open(i, folder.path().c_str(), nullptr); });
    ASSERT_EQ(table.stream_count(instance.handle()), 2u);
    auto first = host::sized<toile_stream>();
    auto second = host::sized<toile_stream>();
    ASSERT_EQ(table.describe(instance.handle(), 0, &first), TOILE_OK);
    ASSERT_EQ(table.describe(instance.handle(), 1, &second), TOILE_OK);
    EXPECT_EQ(first.depth.width, 4u);
    EXPECT_EQ(first.depth.fx, 5.0);
    EXPECT_EQ(first.color.width, 4u);
    EXPECT_EQ(second.color.width, 0u);
    EXPECT_EQ(first.has_world, 1u);
    EXPECT_EQ(first.world_from_camera[13], 2.0); // column-major: y of where it stands
    EXPECT_EQ(second.has_world, 0u);
}

} // namespace
} // namespace toile::capture_sensor
