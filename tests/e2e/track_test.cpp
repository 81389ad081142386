// People followed before a simulated camera, and a garment on them.
#include "body/track_file.h"
#include "core/bytes.h"
#include "core/json.h"
#include "imaging/indexed_image.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kFrames = 24;

constexpr const char* kTurning = R"({"schema": 1, "frames": 24,
    "people": [{"body": {"avatar": "woman"}, "turntable_s": 8, "hair": {}}],
    "scene": {"walls": [{"position": [0, 0, -1.5]}]},
    "cameras": [{"name": "front", "position": [0, 1.2, 2.6], "look_at": [0, 0.95, 0]}]})";

constexpr const char* kNobody = R"({"schema": 1, "frames": 4,
    "people": [{"body": {"avatar": "mannequin"}, "position": [30, 0, 0]}],
    "scene": {"walls": [{"position": [0, 0, -1.5]}]},
    "cameras": [{"name": "front", "position": [0, 1.2, 2.6], "look_at": [0, 0.95, 0]}]})";

class TrackTest : public testing::Test {
  protected:
    void write(const char* scenario) { write_text(folder_ / "scenario.json", scenario); }
    [[nodiscard]] std::string simulated() const {
        return "simulated:" + (folder_ / "scenario.json").string();
    }
    [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }
    ProgramResult track(const std::string& source, const char* out,
                        std::vector<std::string> more = {}) {
        std::vector<std::string> words = {"track", "--source", source, "--out", at(out)};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words);
    }

    TemporaryFolder folder_;
};

TEST_F(TrackTest, FollowsSomebodyAsTheTruthHasIt) {
    write(kTurning);
    ASSERT_EQ(
        run_toile({"record", "--source", simulated(), "--out", at("capture"), "--no-surfaces"})
            .status,
        0);
    const auto run = track("capture:" + at("capture"), "track.jsonl",
                           {"--report", at("report.json"), "--pictures", at("pictures")});
    ASSERT_EQ(run.status, 0) << run.output;
    const auto found = body::read_track_frames(at("track.jsonl"));
    const auto truth = body::read_track_frames(folder_ / "capture" / "truth.jsonl");
    ASSERT_EQ(found.size(), std::size_t{kFrames});
    for (std::size_t f = 0; f < found.size(); ++f) {
        ASSERT_EQ(found[f].people.size(), 1u) << "frame " << f;
        EXPECT_EQ(found[f].people[0].id, 1u);
        EXPECT_NEAR(found[f].time_s, truth[f].time_s, 1e-6);
        float sum = 0.0f;
        for (std::size_t j = 0; j < body::kJointCount; ++j)
            sum += (found[f].people[0].joints[j].translation -
                    truth[f].people[0].joints[j].translation)
                       .norm();
        EXPECT_LT(sum / body::kJointCount, f < 5 ? 0.15f : 0.05f) << "frame " << f;
        if (f > 4) {
            EXPECT_EQ(found[f].people[0].state, body::TrackState::tracked);
        }
    }
    const nlohmann::json report = parse_json_file(folder_ / "report.json");
    EXPECT_EQ(report.at("frames"), kFrames);
    EXPECT_EQ(report.at("people").at("1").at("frames"), kFrames);
    EXPECT_TRUE(report.at("stages").at("source").contains("p95_ms"));
    EXPECT_TRUE(fs::exists(folder_ / "pictures" / "000023.png"));
}

/// A recording with colour, so that all of tracking takes part.
TEST_F(TrackTest, TheSameBytesEveryTimeWithOneAndTwoThreads) {
    write(kTurning);
    ASSERT_EQ(
        run_toile({"record", "--source", simulated(), "--out", at("capture"), "--no-surfaces"})
            .status,
        0);
    const std::string capture = "capture:" + at("capture");
    std::vector<std::uint8_t> first;
    for (const char* threads : {"1", "2", "2"}) {
        ASSERT_EQ(track(capture, "track.jsonl", {"--threads", threads}).status, 0);
        const auto bytes = read_bytes(folder_ / "track.jsonl", 16u << 20);
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first) << threads << " threads";
    }
    EXPECT_FALSE(first.empty());
}

TEST_F(TrackTest, LabelsTellThePartOfEachPixel) {
    write(kTurning);
    const auto run = track(simulated(), "track.jsonl", {"--labels", at("labels"), "--frames", "8"});
    ASSERT_EQ(run.status, 0) << run.output;
    const nlohmann::json json = parse_json_file(folder_ / "labels" / "labels.json");
    ASSERT_EQ(json.at("parts").size(), 12u);
    EXPECT_EQ(json.at("parts")[0].at("name"), "head");
    const auto image = imaging::load_indexed(folder_ / "labels" / "000007.png");
    ASSERT_EQ(image.values.size(), std::size_t{640} * 480);
    std::array<std::size_t, 13> count{};
    for (const std::uint8_t value : image.values) {
        ASSERT_LE(value, 12);
        ++count[value];
    }
    for (std::size_t part = 1; part < count.size(); ++part)
        EXPECT_GT(count[part], 20u) << "part " << part;
    EXPECT_FALSE(fs::exists(folder_ / "labels" / "000008.png"));
    // The same track as without: asking for labels changes nothing.
    ASSERT_EQ(track(simulated(), "plain.jsonl", {"--frames", "8"}).status, 0);
    EXPECT_EQ(read_bytes(folder_ / "plain.jsonl", 16u << 20),
              read_bytes(folder_ / "track.jsonl", 16u << 20));
    const auto unwritable = track(simulated(), "t.jsonl", {"--labels", "/proc/no/labels"});
    EXPECT_EQ(unwritable.status, 1);
    EXPECT_THAT(unwritable.output, HasSubstr("/proc/no/labels"));
}

TEST_F(TrackTest, AMirrorDressesWhoStandsBeforeTheCamera) {
    write(kTurning);
    const auto run =
        run_toile({"mirror", "--source", simulated(), "--garment", "t-shirt", "--headless", "--out",
                   at("pictures"), "--frames", "4", "--picture", "160x240"});
    ASSERT_EQ(run.status, 0) << run.output;
    EXPECT_TRUE(fs::exists(folder_ / "pictures" / "000003.png"));
    const auto frames = body::read_track_frames(folder_ / "pictures" / "track.jsonl");
    ASSERT_EQ(frames.size(), 4u);
    // Their turns on the mannequin's bones, who stands on the floor.
    const auto& feet = frames[3].people[0].joints[static_cast<std::size_t>(body::Joint::left_foot)];
    EXPECT_NEAR(feet.translation.y(), 0.08f, 0.06f);
}

TEST_F(TrackTest, AnEmptyRoomGivesFramesWithNobody) {
    write(kNobody);
    const auto run = track(simulated(), "track.jsonl");
    ASSERT_EQ(run.status, 0) << run.output;
    for (const auto& frame : body::read_track_frames(at("track.jsonl")))
        EXPECT_TRUE(frame.people.empty());
}

TEST_F(TrackTest, WrongUseIsRefusedWithWords) {
    EXPECT_EQ(track("simulated:x.json", "t.jsonl", {"--people", "7"}).status, 2);
    EXPECT_EQ(track("nothing", "t.jsonl").status, 2);
    const auto missing = track("capture:" + at("no_such_folder"), "t.jsonl");
    EXPECT_EQ(missing.status, 1);
    EXPECT_THAT(missing.output, HasSubstr("no_such_folder"));
    const auto log = track("kinect-log:" + at("some.csv"), "t.jsonl");
    EXPECT_EQ(log.status, 1);
    EXPECT_THAT(log.output, HasSubstr("gives no camera pictures"));
    write(kNobody);
    const auto unwritable =
        run_toile({"track", "--source", simulated(), "--out", "/proc/no/track.jsonl"});
    EXPECT_EQ(unwritable.status, 1);
    EXPECT_THAT(unwritable.output, HasSubstr("/proc/no/track.jsonl"));
}

} // namespace
} // namespace toile::test
