// The mirror of a shop as a whole: a visit, its privacy, and what it goes on through.
#include "core/json.h"
#include "kiosk_visit.h"

#include <gmock/gmock.h>
#include <regex>

namespace toile::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Two people side by side.
constexpr const char* kTwo = R"({"schema": 1, "frames": 400,
    "people": [{"body": {"avatar": "woman"}, "position": [-0.7, 0, 0]},
               {"body": {"avatar": "man"}, "position": [0.7, 0, 0]}],
    "scene": {"walls": [{"position": [0, 0, -1.4]}]},
    "cameras": [{"name": "front", "position": [0, 1.2, 3.0], "look_at": [0, 0.95, 0]}]})";

/// Nobody, ever.
constexpr const char* kEmpty = R"({"schema": 1, "frames": 400, "people": [],
    "scene": {"walls": [{"position": [0, 0, -1.4]}]},
    "cameras": [{"name": "front", "position": [0, 1.2, 2.6], "look_at": [0, 0.95, 0]}]})";

TEST_F(KioskTest, NothingIsLeftOnDisk) {
    configure(R"("people": 1, "measure": true)");
    write("visit.json", R"({"schema": 1, "steps": [{"frame": 20, "act": "agree"},
        {"frame": 172, "act": "next_garment"}, {"frame": 178, "act": "finish"}]})");
    const fs::path place = folder_ / "place";
    for (const char* name : {"home", "work", "tmp", "cache", "config", "data", "run"})
        fs::create_directories(place / name);
    const std::string p = place.string();
    // What the program has open while it runs is looked at from outside.
    const std::string script =
        "cd " + p + "/work && HOME=" + p + "/home TMPDIR=" + p + "/tmp XDG_CACHE_HOME=" + p +
        "/cache XDG_CONFIG_HOME=" + p + "/config XDG_DATA_HOME=" + p +
        "/data XDG_RUNTIME_DIR=" + p + "/run " + toile_program() + " kiosk --config " +
        at("kiosk.json") + " --source " + simulated() + " --headless --frames 196 --script " +
        at("visit.json") +
        " & pid=$!; looks=0; while kill -0 $pid 2>/dev/null; do "
        "for fd in /proc/$pid/fd/*; do what=$(readlink $fd); case \"$what\" in "
        "socket:*) echo OPEN SOCKET $what;; " +
        p +
        "/*) echo OPEN FILE $what;; esac; done; "
        "looks=$((looks+1)); sleep 0.1; done; wait $pid; echo status $? looks $looks";
    const ProgramResult run = run_program({"sh", "-c", script});
    EXPECT_THAT(run.output, HasSubstr("status 0"));
    EXPECT_THAT(run.output, Not(HasSubstr("looks 0"))) << run.output;
    EXPECT_THAT(run.output, Not(HasSubstr("OPEN"))) << run.output;
    EXPECT_THAT(run.output, Not(HasSubstr("warning"))) << "the visit went as it should";
    for (const auto& entry : fs::recursive_directory_iterator(place))
        EXPECT_TRUE(entry.is_directory()) << entry.path() << " was left";
}

TEST_F(KioskTest, AVisitIsDrawnTheSameTwiceWithOneAndTwoThreads) {
    write("visit.json", R"({"schema": 1, "steps": [{"frame": 4, "picture": "nobody_asked"},
        {"frame": 20, "picture": "consent"}, {"frame": 21, "act": "agree"},
        {"frame": 30, "picture": "dressed"}, {"frame": 31, "act": "next_garment"},
        {"frame": 36, "picture": "other"}, {"frame": 37, "act": "freeze"},
        {"frame": 60, "picture": "frozen"}, {"frame": 61, "act": "finish"},
        {"frame": 64, "picture": "goodbye"}]})");
    for (const char* threads : {"1", "2"}) {
        const std::string out = at(threads);
        const auto run = kiosk(
            {"--frames", "66", "--script", at("visit.json"), "--out", out, "--threads", threads},
            std::string("LP_NUM_THREADS=") + threads);
        ASSERT_EQ(run.status, 0) << run.output;
    }
    for (const char* name : {"consent", "dressed", "other", "frozen", "goodbye"}) {
        const std::string file = std::string(name) + ".png";
        EXPECT_EQ(read_bytes(folder_ / "1" / file, 16u << 20),
                  read_bytes(folder_ / "2" / file, 16u << 20))
            << name;
    }
    const fs::path pictures = folder_ / "1";
    EXPECT_GT(difference(pictures / "consent.png", pictures / "dressed.png"), 0.3);
    EXPECT_GT(difference(pictures / "dressed.png", pictures / "other.png"), 0.02);
    EXPECT_GT(difference(pictures / "other.png", pictures / "frozen.png"), 0.3);
    // No picture of anybody before consent and after goodbye: these screens are plain.
    EXPECT_LT(difference(pictures / "nobody_asked.png", pictures / "goodbye.png"), 0.35);
}

TEST_F(KioskTest, WithoutConsentNothingIsWornOrCounted) {
    configure(R"("people": 1, "metrics": "kiosk.prom")");
    write("visit.json", R"({"schema": 1, "steps": [{"frame": 20, "act": "decline"},
        {"frame": 25, "act": "next_garment"}, {"frame": 30, "act": "agree"}]})");
    const auto run = kiosk({"--frames", "40", "--script", at("visit.json")});
    ASSERT_EQ(run.status, 0) << run.output;
    const std::string metrics = text_of("kiosk.prom");
    EXPECT_THAT(metrics, HasSubstr("toile_kiosk_declined_total 1\n"));
    EXPECT_THAT(metrics, HasSubstr("toile_kiosk_visits_total 0\n"));
    EXPECT_THAT(metrics, HasSubstr("toile_kiosk_garments_total 0\n"));
    EXPECT_THAT(metrics, HasSubstr("screen{name=\"goodbye\"} 1\n"));
}

TEST_F(KioskTest, NobodyIsAskedInAnEmptyRoom) {
    configure(R"("people": 1, "metrics": "kiosk.prom")");
    write("scenario.json", kEmpty);
    ASSERT_EQ(kiosk({"--frames", "30"}).status, 0);
    EXPECT_THAT(text_of("kiosk.prom"), HasSubstr("screen{name=\"attract\"} 1\n"));
}

TEST_F(KioskTest, TwoPeopleWearWhatEachOfThemAskedFor) {
    configure(R"("people": 2, "metrics": "kiosk.prom")");
    write("scenario.json", kTwo);
    write("visit.json", R"({"schema": 1, "steps": [{"frame": 22, "act": "agree"},
        {"frame": 28, "picture": "one"}, {"frame": 29, "act": "agree", "person": 2},
        {"frame": 34, "picture": "both"}, {"frame": 35, "act": "next_garment", "person": 2},
        {"frame": 40, "picture": "other"}]})");
    const auto run = kiosk({"--frames", "42", "--script", at("visit.json"), "--out", at("out"),
                            "--screen", "480x360"});
    ASSERT_EQ(run.status, 0) << run.output;
    EXPECT_GT(difference(folder_ / "out" / "one.png", folder_ / "out" / "both.png"), 0.01);
    EXPECT_GT(difference(folder_ / "out" / "both.png", folder_ / "out" / "other.png"), 0.01);
    EXPECT_THAT(text_of("kiosk.prom"), HasSubstr("toile_kiosk_garments_total 3\n"));
}

TEST_F(KioskTest, ASnapshotIsKeptOnRequestOnlyAndWithoutButtons) {
    configure(R"("people": 1, "snapshots": "shots")");
    fs::create_directory(folder_ / "shots");
    write("visit.json", R"({"schema": 1, "steps": [{"frame": 20, "act": "agree"},
        {"frame": 30, "act": "snapshot"}, {"frame": 30, "picture": "screen"}]})");
    const auto run = kiosk({"--frames", "36", "--script", at("visit.json"), "--out", at("out")});
    ASSERT_EQ(run.status, 0) << run.output;
    EXPECT_TRUE(fs::exists(folder_ / "shots" / "look-0001.png"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "shots"), fs::directory_iterator()),
              1);
    EXPECT_GT(difference(folder_ / "shots" / "look-0001.png", folder_ / "out" / "screen.png"),
              0.02);
}

TEST_F(KioskTest, WrongUseIsRefusedWithWords) {
    const auto no_source = run_toile({"kiosk", "--headless"});
    EXPECT_EQ(no_source.status, 2);
    EXPECT_THAT(no_source.output, HasSubstr("--source"));
    const auto language = kiosk({"--language", "xx", "--frames", "1"});
    EXPECT_NE(language.status, 0);
    EXPECT_THAT(language.output, HasSubstr("de, en"));
    const auto screen = run_toile({"kiosk", "--preview", "nothing", "--out", at("a.png")});
    EXPECT_EQ(screen.status, 2);
    EXPECT_THAT(screen.output, HasSubstr("consent"));
    configure(R"("langage": "de")");
    const auto config = kiosk({"--frames", "1"});
    EXPECT_EQ(config.status, 1);
    EXPECT_THAT(config.output, HasSubstr("langage"));
}

} // namespace
} // namespace toile::test
