// From a scenario to capture folders with truth, and back through the recorded sensor.
#include "core/bytes.h"
#include "core/json.h"
#include "imaging/capture_folder.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <gmock/gmock.h>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string text_of(const fs::path& file) {
    const auto bytes = read_bytes(file, 256u << 20);
    return {bytes.begin(), bytes.end()};
}

/// Every file below a folder by its path, with its bytes.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            out[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
    return out;
}

class RecordTest : public testing::Test {
  protected:
    ProgramResult record(const std::string& scenario, const std::string& out,
                         std::vector<std::string> more = {}) {
        write_text(folder_ / "scenario.json", scenario);
        std::vector<std::string> words = {"record", "--source",
                                          "simulated:" + (folder_ / "scenario.json").string(),
                                          "--out", (folder_ / out).string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words);
    }

    TemporaryFolder folder_;
};

constexpr const char* kTwoCameras = R"({"schema": 1, "frames": 3, "noise": {"preset": "full"},
    "people": [{"body": {"avatar": "mannequin"}, "turntable_s": 1}],
    "cameras": [{"name": "front"}, {"name": "left", "model": "kinect_v2", "mount": "upright",
                 "position": [2, 1, 0]}]})";

TEST_F(RecordTest, WritesACaptureOfEachCameraWithItsTruth) {
    ASSERT_EQ(record(kTwoCameras, "out").status, 0);
    const imaging::Capture capture = imaging::open_capture(folder_ / "out");
    ASSERT_EQ(capture.cameras.size(), 2u);
    EXPECT_EQ(capture.cameras[0].name, "front");
    EXPECT_EQ(capture.cameras[1].intrinsics.width, 424);
    for (const imaging::CaptureCamera& camera : capture.cameras) {
        ASSERT_EQ(camera.frames.size(), 3u);
        EXPECT_NEAR(camera.frames[2].time_s, 2.0 / 30.0, 1e-6);
        ASSERT_TRUE(camera.world_from_camera);
        EXPECT_TRUE(camera.load_color(0));
        const fs::path truth = folder_ / "out" / camera.name / "truth_camera.json";
        const nlohmann::json json = parse_json_file(truth);
        const double scale = json.at("depth_scale");
        EXPECT_NE(scale, 1.0);
        EXPECT_NEAR(scale, 1.0, 0.005);
        std::istringstream lines(text_of(folder_ / "out" / camera.name / "truth.jsonl"));
        int count = 0;
        for (std::string line; std::getline(lines, line); ++count)
            EXPECT_EQ(nlohmann::json::parse(line).at("people").size(), 1u);
        EXPECT_EQ(count, 3);
    }
    EXPECT_TRUE(fs::exists(folder_ / "out/truth/surfaces.glb"));
    EXPECT_TRUE(fs::exists(folder_ / "out/truth/frames/000002.f32"));
}

TEST_F(RecordTest, GivesTheSameBytesForOneAndTwoThreads) {
    ASSERT_EQ(record(kTwoCameras, "one", {"--threads", "1"}).status, 0);
    ASSERT_EQ(record(kTwoCameras, "two", {"--threads", "2"}).status, 0);
    const auto one = contents(folder_ / "one");
    const auto two = contents(folder_ / "two");
    ASSERT_EQ(one.size(), two.size());
    for (const auto& [file, bytes] : one) {
        ASSERT_TRUE(two.contains(file)) << file;
        EXPECT_TRUE(bytes == two.at(file)) << file << " differs";
    }
}

TEST_F(RecordTest, ARecordingRecordedAgainHasTheSameDepth) {
    ASSERT_EQ(record(kTwoCameras, "out", {"--frames", "2", "--no-surfaces"}).status, 0);
    EXPECT_FALSE(fs::exists(folder_ / "out/truth"));
    const ProgramResult again =
        run_toile({"record", "--source", "capture:" + (folder_ / "out/front").string(), "--out",
                   (folder_ / "again").string()});
    ASSERT_EQ(again.status, 0) << again.output;
    for (const char* file : {"depth/000000.png", "depth/000001.png", "intrinsic.json",
                             "extrinsic.json", "timestamps.csv"})
        EXPECT_EQ(text_of(folder_ / "out/front" / file), text_of(folder_ / "again" / file)) << file;
    EXPECT_FALSE(fs::exists(folder_ / "again/truth.jsonl")); // a recording knows no truth
}

TEST_F(RecordTest, ADressedAnimationIsSeenThroughItsCache) {
    const std::string motion = std::string(TOILE_SOURCE_DIR) + "/avatars/motions/turn.json";
    const ProgramResult dressed =
        run_toile({"tryon", "--garment", "skirt", "--animation", motion, "--frames", "3",
                   "--picture", "60x80", "--quality", "fast", "--out", (folder_ / "pics").string(),
                   "--cache", (folder_ / "cache").string()});
    ASSERT_EQ(dressed.status, 0) << dressed.output;
    const std::string scene = R"(, "color": false, "frames": 3, "noise": {"preset": "none"},
        "scene": {"floor": false}, "cameras": [{"position": [0, 0.8, 2]}]})";
    ASSERT_EQ(
        record(R"({"schema": 1, "people": [{"body": {"surfaces": "cache"}}])" + scene, "dressed")
            .status,
        0);
    ASSERT_EQ(record(R"({"schema": 1, "people": [{"body": {"avatar": "mannequin"},
                         "motion": ")" +
                         motion + "\"}]" + scene,
                     "bare")
                  .status,
              0);
    // The skirt covers more of the picture, and where both show something it is in front.
    const auto dressed_depth = imaging::open_capture(folder_ / "dressed").cameras[0].load_depth(2);
    const auto bare_depth = imaging::open_capture(folder_ / "bare").cameras[0].load_depth(2);
    int more = 0;
    int behind = 0;
    for (std::size_t i = 0; i < dressed_depth.metres.size(); ++i) {
        const float a = dressed_depth.metres[i];
        const float b = bare_depth.metres[i];
        more += !std::isnan(a) && std::isnan(b) ? 1 : 0;
        behind += std::isnan(a) && !std::isnan(b) ? 1 : 0;
        if (!std::isnan(a) && !std::isnan(b)) {
            EXPECT_LT(a, b + 0.004f);
        }
    }
    EXPECT_GT(more, 500);
    EXPECT_LT(behind, 50);
}

TEST_F(RecordTest, WhatIsWrongIsOneLine) {
    const auto fails = [&](const std::string& scenario, const std::string& text) {
        const ProgramResult result = record(scenario, "bad");
        EXPECT_EQ(result.status, 1) << result.output;
        EXPECT_THAT(result.output, HasSubstr(text));
        EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
        EXPECT_FALSE(fs::exists(folder_ / "bad"));
    };
    fails(R"({"schema": 1})", "cameras");
    fails(R"({"schema": 1, "cameras": [{}], "persons": []})", "persons");
    fails(R"({"schema": 1, "cameras": [{}], "people": [{"body": {"mesh": "gone.ply"}}]})",
          "gone.ply");
    fails("{", "scenario.json");
    EXPECT_EQ(run_toile({"record", "--source", "nowhere", "--out", "x"}).status, 2);
    EXPECT_THAT(run_toile({"record", "--source", "kinect-log:a.csv", "--out", "x"}).output,
                HasSubstr("no camera pictures"));
    ASSERT_EQ(record(kTwoCameras, "twice").status, 0);
    EXPECT_THAT(record(kTwoCameras, "twice").output, HasSubstr("already holds"));
}

constexpr const char* kOneCamera = R"({"schema": 1, "frames": 4, "noise": {"preset": "usual"},
    "people": [{"body": {"avatar": "mannequin"}, "turntable_s": 1}],
    "cameras": [{"name": "front"}]})";

TEST_F(RecordTest, AnOniFileThatOpenNiPlaysGivesTheSamePictures) {
    ASSERT_EQ(record(kOneCamera, "direct").status, 0);
    const auto written = record(kOneCamera, "played.oni");
    ASSERT_EQ(written.status, 0) << written.output;
    EXPECT_THAT(written.output, HasSubstr("does not say where the camera stands"));
    const auto played =
        run_toile({"record", "--source", "openni2:" + (folder_ / "played.oni").string(), "--out",
                   (folder_ / "played").string()});
    ASSERT_EQ(played.status, 0) << played.output;
    const auto direct = contents(folder_ / "direct"), back = contents(folder_ / "played");
    std::size_t pictures = 0;
    for (const auto& [name, bytes] : back) {
        if (name.rfind("depth/", 0) != 0 && name.rfind("color/", 0) != 0) continue;
        ++pictures;
        EXPECT_TRUE(bytes == direct.at(name)) << name;
    }
    EXPECT_EQ(pictures, 8u);
    // It is not written over, and one file holds one camera.
    const auto again = record(kOneCamera, "played.oni");
    EXPECT_EQ(again.status, 1);
    EXPECT_THAT(again.output, HasSubstr("is there already"));
    const auto two = record(kTwoCameras, "two.oni");
    EXPECT_EQ(two.status, 2);
    EXPECT_THAT(two.output, HasSubstr("holds one camera"));
    EXPECT_FALSE(fs::exists(folder_ / "two.oni"));
}

TEST_F(RecordTest, ACameraThatIsNotThereIsExplained) {
    const auto missing =
        run_toile({"record", "--source", "openni2:99", "--out", (folder_ / "x").string()});
    EXPECT_EQ(missing.status, 1);
    EXPECT_THAT(missing.output, HasSubstr("no such camera"));
    const auto file =
        run_toile({"record", "--source", "openni2:nothing.oni", "--out", (folder_ / "x").string()});
    EXPECT_EQ(file.status, 1);
    EXPECT_THAT(file.output, HasSubstr("nothing.oni: there is no such recording"));
    EXPECT_FALSE(fs::exists(folder_ / "x"));
}

} // namespace
} // namespace toile::test
