// The main job end to end: dressed, moving, measured, and the same bytes every time.
#include "imaging/image.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/text_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

nlohmann::json report(const fs::path& file) {
    return nlohmann::json::parse(file_text(file));
}

// Every file of a folder but films and reports, whose contents may hold times.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() != ".mp4")
            out[entry.path().filename()] = file_text(entry.path());
    return out;
}

// A short recording of one person who lifts an arm, written by the test: 25 joints of a Kinect v2,
// 2.5 m from a camera 0.9 m above the floor.
fs::path write_log(const fs::path& file, int frames) {
    struct Place {
        double x, y, z;
    };
    const std::array<Place, 25> standing = {{
        {0, 0.05, 2.5},      {0, 0.35, 2.5},      {0, 0.62, 2.5},       {0, 0.78, 2.5},
        {-0.18, 0.52, 2.5},  {-0.24, 0.25, 2.5},  {-0.26, 0.02, 2.5},   {-0.27, -0.05, 2.5},
        {0.18, 0.52, 2.5},   {0.24, 0.25, 2.5},   {0.26, 0.02, 2.5},    {0.27, -0.05, 2.5},
        {-0.09, 0.02, 2.5},  {-0.10, -0.40, 2.5}, {-0.11, -0.80, 2.5},  {-0.12, -0.87, 2.4},
        {0.09, 0.02, 2.5},   {0.10, -0.40, 2.5},  {0.11, -0.80, 2.5},   {0.12, -0.87, 2.4},
        {0, 0.56, 2.5},      {-0.27, -0.12, 2.5}, {-0.23, -0.05, 2.45}, {0.27, -0.12, 2.5},
        {0.23, -0.05, 2.45},
    }};
    std::ofstream out(file);
    for (int i = 0; i < frames; ++i) {
        out << 1000000000LL + 333333LL * i;
        const double lift = std::min(1.0, i / 20.0) * 1.4; // radians, away from hanging
        for (std::size_t j = 0; j < standing.size(); ++j) {
            Place p = standing[j];
            const bool right_arm = (j >= 9 && j <= 11) || j == 23 || j == 24;
            if (right_arm) { // turns about the shoulder
                const double dx = p.x - 0.18;
                const double dy = p.y - 0.52;
                p.x = 0.18 + std::cos(lift) * dx - std::sin(lift) * dy;
                p.y = 0.52 + std::sin(lift) * dx + std::cos(lift) * dy;
            }
            out << ',' << p.x << ',' << p.y << ',' << p.z << ",2";
        }
        out << '\n';
    }
    return file;
}

class TryOnTest : public testing::Test {
  protected:
    ProgramResult mirror(const std::string& out, int frames,
                         const std::vector<std::string>& more = {}) {
        const fs::path log = write_log(folder_ / "log.csv", 30);
        std::vector<std::string> words = {"mirror",
                                          "--source",
                                          "kinect-log:" + log.string(),
                                          "--garment",
                                          "t-shirt,skirt",
                                          "--headless",
                                          "--out",
                                          (folder_ / out).string(),
                                          "--picture",
                                          "180x240",
                                          "--quality",
                                          "fast",
                                          "--frames",
                                          std::to_string(frames)};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words);
    }

    TemporaryFolder folder_;
};

TEST_F(TryOnTest, MirrorDressesEveryFrameAndReports) {
    const fs::path file = folder_ / "r.json";
    const ProgramResult result = mirror("out", 30, {"--report", file.string()});
    ASSERT_EQ(result.status, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("compute"));
    EXPECT_TRUE(fs::exists(folder_ / "out" / "000029.png"));
    EXPECT_TRUE(fs::exists(folder_ / "out" / "track.jsonl"));

    const nlohmann::json json = report(file);
    EXPECT_EQ(json["frames"], 30);
    EXPECT_EQ(json["dropped"], 0);
    EXPECT_LE(json["garment"]["deep_fraction_max"].get<double>(), 0.005);
    EXPECT_LE(json["skin"]["visible_fraction_max"].get<double>(), 0.001);
    for (const char* stage : {"source", "skinning", "targets", "cloth", "surfaces", "drawing"})
        EXPECT_GT(json["stages"][stage]["max_ms"].get<double>(), 0.0) << stage;
    EXPECT_FALSE(json.contains("latency")) << "lock-step has no latency";
    EXPECT_EQ(json["seed"], 1);
}

TEST_F(TryOnTest, MirrorWithoutHeadlessShowsAWindow) {
    if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "no xvfb-run here";
    const fs::path log = write_log(folder_ / "log.csv", 30);
    const fs::path file = folder_ / "r.json";
    const ProgramResult result =
        run_program({"xvfb-run", "-a", "-s", "-screen 0 640x480x24", toile_program(), "mirror",
                     "--source", "kinect-log:" + log.string(), "--garment", "t-shirt", "--picture",
                     "180x240", "--quality", "fast", "--report", file.string()});
    ASSERT_EQ(result.status, 0) << result.output;
    const nlohmann::json json = report(file);
    EXPECT_EQ(json["frames"].get<int>() + json["dropped"].get<int>(), 30);
    EXPECT_GT(json["latency"]["picture"]["median_ms"].get<double>(), 0.0) << "nothing was shown";
}

TEST_F(TryOnTest, WithoutADisplayMirrorSaysWhatToDo) {
    const fs::path log = write_log(folder_ / "log.csv", 30);
    const ProgramResult result =
        run_toile({"mirror", "--source", "kinect-log:" + log.string(), "--garment", "t-shirt"},
                  "env -u DISPLAY");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.output, HasSubstr("--headless"));
}

TEST_F(TryOnTest, TheSameBytesTwiceAndWithOneOrTwoThreads) {
    ASSERT_EQ(mirror("a", 8, {"--threads", "1"}).status, 0);
    ASSERT_EQ(mirror("b", 8, {"--threads", "2"}).status, 0);
    ASSERT_EQ(mirror("c", 8, {"--threads", "2"}).status, 0);
    const auto a = contents(folder_ / "a");
    EXPECT_EQ(a.size(), 9u); // 8 pictures and the track
    EXPECT_TRUE(a == contents(folder_ / "b")) << "one thread and two differ";
    EXPECT_TRUE(contents(folder_ / "b") == contents(folder_ / "c")) << "two runs differ";
}

TEST_F(TryOnTest, TheArmThatIsLiftedMovesThePicture) {
    ASSERT_EQ(mirror("out", 30).status, 0);
    EXPECT_NE(file_text(folder_ / "out" / "000000.png"), file_text(folder_ / "out" / "000025.png"));
}

TEST_F(TryOnTest, RealtimeReportsLatencyAndCountsEveryFrame) {
    const fs::path file = folder_ / "r.json";
    const ProgramResult result = mirror("out", 30, {"--realtime", "--report", file.string()});
    ASSERT_EQ(result.status, 0) << result.output;
    const nlohmann::json json = report(file);
    EXPECT_TRUE(json.contains("latency"));
    EXPECT_GE(json["latency"]["picture"]["p95_ms"], json["latency"]["garment_state"]["median_ms"]);
    EXPECT_LE(json["frames"].get<int>() + json["dropped"].get<int>(), 30);
}

TEST_F(TryOnTest, TryOnWritesThePictureAndAThreeDimensionalFile) {
    const fs::path png = folder_ / "look.png";
    const fs::path glb = folder_ / "look.glb";
    const ProgramResult result = run_toile(
        {"tryon", "--body", "woman", "--garment", "t-shirt,skirt", "--views", "front,back",
         "--picture", "180x240", "--out", png.string(), "--glb", glb.string()});
    ASSERT_EQ(result.status, 0) << result.output;
    const imaging::Image picture = imaging::load_image(png);
    EXPECT_EQ(picture.width, 360);
    EXPECT_EQ(picture.height, 240);
    EXPECT_EQ(file_text(glb).substr(0, 4), "glTF");
}

TEST_F(TryOnTest, AnAnimationFillsAFolder) {
    const std::string motion = std::string(TOILE_SOURCE_DIR) + "/avatars/motions/turn.json";
    const ProgramResult result = run_toile({"tryon", "--garment", "skirt", "--animation", motion,
                                            "--frames", "5", "--picture", "120x160", "--quality",
                                            "fast", "--out", (folder_ / "out").string()});
    ASSERT_EQ(result.status, 0) << result.output;
    EXPECT_TRUE(fs::exists(folder_ / "out" / "000004.png"));
    EXPECT_FALSE(fs::exists(folder_ / "out" / "000005.png"));
}

} // namespace
} // namespace toile::test
