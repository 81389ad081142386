// Capture folders as cameras: every frame in turn, or the newest that is due.
#define TOILE_STATIC_PLUGIN
#include "capture_sensor/capture_player.h"
#include "host/contract.h"
#include "host/instance.h"
#include "host/views.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>
#include <fstream>
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

/// The plugin as the host sees it; its own sample would be a folder, so this one is written here.
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
