// What the mirror goes on through: each fault five times, and each is said on the operator's line.
#include "kiosk_visit.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <regex>

namespace toile::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class KioskFaults : public KioskTest {
  protected:
    void SetUp() override {
        KioskTest::SetUp();
        // Nothing here is about the picture's colours, and half of what a frame costs is theirs.
        write("scenario.json", std::regex_replace(std::string(kTurning), std::regex("\"frames\""),
                                                  "\"color\": false, \"frames\""));
    }
    /// Nobody is taken for gone because the machine has other work, and frames are far apart.
    void wait_for_people() {
        write("kiosk.json", std::regex_replace(text_of("kiosk.json"), std::regex("\"away_s\": 0.5"),
                                               "\"away_s\": 60"));
    }
    /// A folder of plugins with one that does what `fault` says, before all others of its kind.
    std::string faulty_plugins(const std::string& fault) {
        const fs::path place = folder_ / "plugins" / fault;
        fs::create_directories(place);
        fs::copy_file(fs::path(TOILE_FAULTY_CLOTH), place / "libfaulty_cloth.so");
        write_text(place / "plugin.json", R"({"id": "test.faulty_cloth", "version": "1.0.0",
            "abi": {"major": 1, "minor": 0}, "library": "libfaulty_cloth.so",
            "provides": ["toile.cloth/1"], "licence": "Apache-2.0", "priority": 50})");
        return (folder_ / "plugins").string();
    }
};

TEST_F(KioskFaults, CameraPictureAndDiskAreLostFiveTimesEachAndTheMirrorStaysUp) {
    configure(R"("people": 1, "metrics": "kiosk.prom", "snapshots": "shots")");
    fs::create_directory(folder_ / "shots");
    std::string steps = R"({"schema": 1, "steps": [{"frame": 20, "act": "agree"})";
    for (int i = 0; i < 5; ++i) {
        const int frame = 30 + 24 * i;
        for (const auto& [at, fault] :
             {std::pair{frame, "camera"}, std::pair{frame + 18, "picture"},
              std::pair{frame + 20, "disk"}})
            steps += R"(, {"frame": )" + std::to_string(at) + R"(, "fault": ")" + fault + "\"}";
        steps += R"(, {"frame": )" + std::to_string(frame + 20) + R"(, "act": "snapshot"})";
    }
    write("visit.json", steps + R"(, {"frame": 154, "picture": "end"}]})");
    // The camera is away for half a second of the mirror's time: longer than that is nobody there.
    write("kiosk.json", std::regex_replace(text_of("kiosk.json"), std::regex("\"away_s\": 0.5"),
                                           "\"away_s\": 1.0"));
    const auto run = kiosk({"--frames", "156", "--script", at("visit.json"), "--out", at("out")});
    ASSERT_EQ(run.status, 0) << run.output;
    const std::string metrics = text_of("kiosk.prom");
    for (const char* fault : {"camera", "picture", "disk"})
        EXPECT_THAT(metrics, HasSubstr("faults_total{kind=\"" + std::string(fault) + "\"} 5\n"));
    EXPECT_THAT(metrics, HasSubstr("camera_up 1\n"));
    EXPECT_THAT(metrics, HasSubstr("screen{name=\"mirror\"} 1\n")) << "the visit goes on";
    EXPECT_EQ(imaging::load_image(folder_ / "out" / "end.png").width, 270);
    // The five pictures fell onto the full disk; nothing half written is left.
    EXPECT_TRUE(fs::is_empty(folder_ / "shots"));
}

TEST_F(KioskFaults, TheWatchdogStartsACrashedAndAStalledMirrorAgain) {
    for (const char* fault : {"crash", "stall"}) {
        configure(R"("people": 1, "metrics": "kiosk.prom", "stall_s": 3)");
        write("visit.json", R"({"schema": 1, "steps": [{"frame": 6, "fault": ")" +
                                std::string(fault) + R"("}]})");
        const auto run = kiosk({"--realtime", "--frames", "12", "--script", at("visit.json")});
        ASSERT_EQ(run.status, 0) << run.output;
        EXPECT_THAT(run.output, HasSubstr("started again"));
        EXPECT_THAT(text_of("kiosk.prom"), HasSubstr("toile_kiosk_restarts_total 1\n"));
    }
}

TEST_F(KioskFaults, AGarmentThatChangesOnDiskIsReadAgainAndABadOneRefused) {
    fs::create_directory(folder_ / "garments");
    for (const char* id : {"tee", "skirt"})
        fs::copy(fs::path(TOILE_SOURCE_DIR) / "garments" / id, folder_ / "garments" / id);
    write("kiosk.json", R"({"schema": 1, "garments_folder": "garments", "width": 270,
        "height": 480, "people": 1, "watchdog": false})");
    const std::string manifest = at("garments/tee/garment.json");
    // Each change waits for what the mirror says of the one before; a minute is never needed.
    const std::string until = "wait_for() { for i in $(seq 600); do grep -q \"$1\" " + at("said") +
                              " && return; sleep 0.1; done; }; ";
    const std::string script =
        until + toile_program() + " kiosk --config " + at("kiosk.json") + " --source " +
        simulated() + " --headless --realtime --frames 100000 >" + at("said") +
        " 2>&1 & pid=$!; sleep 4; cp " + manifest + " " + at("good") + "; echo '{' > " + manifest +
        "; wait_for 'tee is refused'; cp " + at("good") + " " + manifest +
        "; sleep 3; kill -TERM $pid; wait $pid; echo status $?; cat " + at("said");
    const ProgramResult run = run_program({"sh", "-c", script});
    EXPECT_THAT(run.output, HasSubstr("Garment tee is refused"));
    EXPECT_THAT(run.output, HasSubstr("garment.json"));
    EXPECT_THAT(run.output, HasSubstr("status 0")) << "it went on and ended when told to";
}

// Five garments one after another: under each of them the plugin fails anew.
TEST_F(KioskFaults, APluginThatFailsIsSwitchedOffAndClothesFollowTheSkin) {
    configure(R"("people": 1, "metrics": "kiosk.prom")");
    std::string steps = R"({"schema": 1, "steps": [{"frame": 20, "act": "agree"})";
    for (int i = 1; i < 5; ++i)
        steps += R"(, {"frame": )" + std::to_string(20 + 34 * i) + R"(, "act": "next_garment"})";
    write("visit.json", steps + "]}");
    for (const char* fault : {"errors", "throws", "not_finite"}) {
        fs::remove_all(folder_ / "plugins");
        const auto run = kiosk({"--no-draw", "--frames", "190", "--script", at("visit.json"),
                                "--plugins", faulty_plugins(fault)});
        ASSERT_EQ(run.status, 0) << run.output;
        EXPECT_THAT(run.output, HasSubstr("Switched off: test.faulty_cloth")) << fault;
        const std::string metrics = text_of("kiosk.prom");
        EXPECT_THAT(metrics, HasSubstr("faults_total{kind=\"plugin\"} 5\n")) << fault;
        EXPECT_THAT(metrics, HasSubstr("garments_total 5\n")) << fault;
        EXPECT_THAT(metrics, HasSubstr("screen{name=\"mirror\"} 1\n")) << fault;
        EXPECT_THAT(metrics, HasSubstr("frames_total 190\n")) << fault;
    }
}

// What crashes or hangs takes the mirror along; the second time others' plugins are left out.
TEST_F(KioskFaults, APluginThatCrashesOrHangsIsLeftOutAfterTheSecondTime) {
    configure(R"("people": 1, "metrics": "kiosk.prom")");
    wait_for_people();
    // How many frames of the mirror go by until somebody is seen depends on the machine.
    write("visit.json", R"({"schema": 1, "steps": [{"frame": 20, "act": "agree", "every_s": 1}]})");
    for (const char* fault : {"crashes", "hangs"}) {
        fs::remove_all(folder_ / "plugins");
        const auto run = kiosk({"--realtime", "--no-draw", "--frames", "260", "--script",
                                at("visit.json"), "--plugins", faulty_plugins(fault)});
        ASSERT_EQ(run.status, 0) << run.output;
        EXPECT_THAT(run.output, HasSubstr("started again with the stock plugins only")) << fault;
        const std::string metrics = text_of("kiosk.prom");
        EXPECT_THAT(metrics, HasSubstr("toile_kiosk_restarts_total 2\n")) << run.output;
        EXPECT_THAT(metrics, HasSubstr("screen{name=\"mirror\"} 1\n")) << fault;
    }
}

TEST_F(KioskFaults, TheCamerasClockJumpsFiveTimesAheadAndBack) {
    configure(R"("people": 1, "metrics": "kiosk.prom")");
    std::string steps = R"({"schema": 1, "steps": [{"frame": 20, "act": "agree"})";
    for (int i = 0; i < 5; ++i)
        steps += R"(, {"frame": )" + std::to_string(30 + 12 * i) + R"(, "fault": "clock"})";
    write("visit.json", steps + "]}");
    const auto run = kiosk({"--no-draw", "--frames", "96", "--script", at("visit.json")});
    ASSERT_EQ(run.status, 0) << run.output;
    const std::string metrics = text_of("kiosk.prom");
    EXPECT_THAT(metrics, HasSubstr("faults_total{kind=\"clock\"} 5\n"));
    EXPECT_THAT(metrics, HasSubstr("faults_total{kind=\"camera\"} 0\n"));
    EXPECT_THAT(metrics, HasSubstr("faults_total{kind=\"plugin\"} 0\n"));
    EXPECT_THAT(metrics, HasSubstr("visits_total 1\n")) << "nobody was taken for gone";
    EXPECT_THAT(metrics, HasSubstr("screen{name=\"mirror\"} 1\n"));
}

TEST_F(KioskFaults, NothingHangsOnTheSystemsClock) {
    configure(R"("people": 1, "metrics": "kiosk.prom")");
    write("visit.json", R"({"schema": 1, "steps": [{"frame": 20, "act": "agree"},
        {"frame": 40, "picture": "dressed"}]})");
    const std::vector<std::string> words = {"--frames", "42", "--script", at("visit.json"),
                                            "--out"};
    const auto with = [&](const char* out) {
        std::vector<std::string> all = words;
        all.push_back(at(out));
        return all;
    };
    ASSERT_EQ(kiosk(with("still")).status, 0);
    const auto run = kiosk(with("leaping"), "LD_PRELOAD=" TOILE_CLOCK_JUMPS);
    ASSERT_EQ(run.status, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("clock_jumps: asked")) << "the clock did leap";
    EXPECT_EQ(read_bytes(folder_ / "still" / "dressed.png", 16u << 20),
              read_bytes(folder_ / "leaping" / "dressed.png", 16u << 20));
    // On the live clock, with the watchdog: it neither sleeps for hours nor is it started again.
    const auto live =
        kiosk({"--realtime", "--frames", "60", "--script", at("visit.json"), "--out", at("live")},
              "LD_PRELOAD=" TOILE_CLOCK_JUMPS);
    ASSERT_EQ(live.status, 0) << live.output;
    EXPECT_THAT(live.output, Not(HasSubstr("started again"))) << live.output;
    EXPECT_THAT(live.output, Not(HasSubstr("clock jumped"))) << live.output;
}

TEST_F(KioskFaults, OnTheLiveClockTheVisitGoesOnThroughEveryFault) {
    configure(R"("people": 1, "metrics": "kiosk.prom", "snapshots": "shots")");
    wait_for_people();
    fs::create_directory(folder_ / "shots");
    std::string steps = R"({"schema": 1, "steps": [{"frame": 20, "act": "agree"})";
    int frame = 40;
    for (int i = 0; i < 5; ++i)
        for (const char* fault : {"camera", "clock", "picture", "disk"}) {
            steps += R"(, {"frame": )" + std::to_string(frame) + R"(, "fault": ")" + fault + "\"}";
            frame += 12;
        }
    write("visit.json", steps + "]}");
    const auto run = kiosk({"--realtime", "--frames", std::to_string(frame + 20), "--script",
                            at("visit.json"), "--report", at("report.json")});
    ASSERT_EQ(run.status, 0) << run.output;
    // Not the metrics: the last fault of the disk may have met their last page.
    const auto report = nlohmann::json::parse(text_of("report.json"));
    EXPECT_EQ(report["frames"], frame + 20);
    EXPECT_EQ(report["faults"]["picture"], 5);
    // A camera that comes back late takes the next fault of its own along: one of five at least.
    for (const char* fault : {"camera", "clock"})
        EXPECT_GE(report["faults"][fault], 1) << fault;
    EXPECT_EQ(report["garments"], 1) << "one visit, from the first fault to the last";
}

} // namespace
} // namespace toile::test
