// Configuration, words, scripts and metrics: what is read is checked, what is written is whole.
#include "apps/kiosk/config.h"
#include "apps/kiosk/metrics.h"
#include "apps/kiosk/script.h"
#include "apps/kiosk/texts.h"
#include "apps/kiosk/whole_file.h"
#include "core/bytes.h"
#include "core/json.h"
#include "support/json_schema.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>
#include <regex>
#include <set>
#include <sstream>

namespace toile::test {
namespace {

using namespace apps::kiosk;
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kTexts = fs::path(TOILE_SOURCE_DIR) / "engine" / "apps" / "kiosk" / "data" / "texts";

std::string text_of(const fs::path& file) {
    const auto bytes = read_bytes(file, 1u << 20);
    return {bytes.begin(), bytes.end()};
}

template <class Work>
std::string error_of(const Work& work) {
    try {
        work();
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

TEST(KioskTexts, EveryLanguageHasEveryKeyAndTheSameBlanks) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(kTexts))
        files.push_back(entry.path());
    ASSERT_GE(files.size(), 2u);
    const Texts first = Texts::load_file(kTexts / "en.json");
    const std::regex blank("\\{[a-z]+\\}");
    const auto blanks = [&](const std::string& words) {
        std::multiset<std::string> out;
        for (std::sregex_iterator i(words.begin(), words.end(), blank), end; i != end; ++i)
            out.insert(i->str());
        return out;
    };
    for (const fs::path& file : files) {
        const Texts other = Texts::load_file(file);
        for (std::size_t i = 0; i < kTextCount; ++i) {
            const auto key = static_cast<Text>(i);
            EXPECT_EQ(blanks(other[key]), blanks(first[key])) << file << " " << text_key(key);
        }
    }
    EXPECT_EQ(first.with(Text::between_sizes, {{"size", "M"}, {"other", "L"}}),
              "Between M and L: both can be right");
}

TEST(KioskTexts, ALineIsShortenedBetweenLetters) {
    EXPECT_EQ(shortened("0123456789abcdef"), "01234567...");
    EXPECT_EQ(shortened("0123456\u00e4abcdefg"),
              "0123456..."); // the umlaut's second byte is the 8th
    EXPECT_EQ(shortened("\u00fc"), "...");
}

TEST(KioskTexts, AMissingAndAnUnknownKeyAreNamed) {
    const TemporaryFolder folder;
    nlohmann::json json = parse_json_file(kTexts / "de.json");
    json.erase("agree");
    write_text(folder / "xx.json", json.dump());
    EXPECT_THAT(error_of([&] { (void)Texts::load_file(folder / "xx.json"); }), HasSubstr("agree"));
    json["agree"] = "ja";
    json["aggree"] = "ja";
    write_text(folder / "xx.json", json.dump());
    EXPECT_THAT(error_of([&] { (void)Texts::load_file(folder / "xx.json"); }), HasSubstr("aggree"));
    json.erase("aggree");
    json["agree"] = "";
    write_text(folder / "xx.json", json.dump());
    EXPECT_THAT(error_of([&] { (void)Texts::load_file(folder / "xx.json"); }), HasSubstr("agree"));
}

TEST(KioskConfiguration, IsReadAsTheSchemaSays) {
    const TemporaryFolder folder;
    write_text(folder / "kiosk.json", R"({"schema": 1, "source": "openni2:", "language": "de",
        "width": 1920, "height": 1080, "people": 1, "garments_folder": "clothes", "dwell_s": 2,
        "mirror": {"scale": 1.25, "offset_y": -0.05}, "camera": {"height_m": 1.4, "tilt_deg": -8},
        "metrics": "/var/lib/toile/kiosk.prom", "watchdog": false})");
    EXPECT_THAT(JsonSchema("kiosk.schema.json").faults(parse_json_file(folder / "kiosk.json")),
                testing::IsEmpty());
    const KioskConfig config = load_config(folder / "kiosk.json");
    EXPECT_EQ(config.source, "openni2:");
    EXPECT_EQ(config.garments_folder, folder / "clothes");
    EXPECT_EQ(config.metrics, "/var/lib/toile/kiosk.prom");
    EXPECT_TRUE(config.snapshots.empty());
    EXPECT_DOUBLE_EQ(config.mirror.scale, 1.25);
    EXPECT_DOUBLE_EQ(config.camera.tilt_deg, -8.0);
    EXPECT_FALSE(config.watchdog);
}

TEST(KioskConfiguration, WhatIsWrongIsNamed) {
    const TemporaryFolder folder;
    const auto refusal = [&](const char* text) {
        write_text(folder / "kiosk.json", text);
        return error_of([&] { (void)load_config(folder / "kiosk.json"); });
    };
    EXPECT_THAT(refusal(R"({"schema": 1, "langage": "de"})"), HasSubstr("langage"));
    EXPECT_THAT(refusal(R"({"schema": 1, "people": 3})"), HasSubstr("people"));
    EXPECT_THAT(refusal(R"({"schema": 1, "mirror": {"scale": 0.5}})"), HasSubstr("/mirror/scale"));
    EXPECT_THAT(refusal(R"({"schema": 1, "camera": {"roll": 1}})"), HasSubstr("/camera"));
    EXPECT_THAT(refusal(R"({"language": "de"})"), HasSubstr("schema"));
}

TEST(KioskConfiguration, TheSetUpIsWrittenBackAndTheRestStays) {
    const TemporaryFolder folder;
    write_text(folder / "kiosk.json", R"({"schema": 1, "source": "openni2:", "dwell_s": 0.9})");
    save_setup(folder / "kiosk.json", {1.1, 0.02, -0.03}, {1.35, -6.5});
    const KioskConfig config = load_config(folder / "kiosk.json");
    EXPECT_EQ(config.source, "openni2:");
    EXPECT_DOUBLE_EQ(config.dwell_s, 0.9);
    EXPECT_DOUBLE_EQ(config.mirror.offset_x, 0.02);
    EXPECT_DOUBLE_EQ(config.camera.height_m, 1.35);
}

TEST(KioskFiles, AFileThatCannotBeWrittenLeavesTheOldOne) {
    const TemporaryFolder folder;
    write_whole(folder / "a.prom", "one\n");
    write_whole(folder / "a.prom", "two\n");
    EXPECT_EQ(text_of(folder / "a.prom"), "two\n");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
    EXPECT_THAT(error_of([&] { write_whole(folder.path() / "no" / "a.prom", "x"); }),
                HasSubstr("a.prom"));
    // Every write through this link fails as on a full disk.
    fs::create_symlink("/dev/full", folder / "a.prom.new");
    EXPECT_NE(error_of([&] { write_whole(folder / "a.prom", "three\n"); }), "no error");
    EXPECT_EQ(text_of(folder / "a.prom"), "two\n");
    EXPECT_FALSE(fs::is_symlink(folder / "a.prom.new"));
    // A device is not replaced by a file.
    EXPECT_THAT(error_of([] { write_whole("/dev/null", "x"); }), HasSubstr("/dev/null"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(KioskScript, StepsComeAgainAfterTheirTime) {
    const TemporaryFolder folder;
    write_text(folder / "s.json", R"({"schema": 1, "steps": [
        {"frame": 3, "act": "next_garment", "every_s": 5}, {"frame": 9, "quit": true}]})");
    const Script script = load_script(folder / "s.json");
    int times = 0;
    for (int i = 0; i < 1000; ++i) // 100 s from 2 s on
        times += static_cast<int>(
            script.between({2.0, -1.0}, 2.0 + 0.1 * i, 2.0 + 0.1 * (i + 1)).size());
    EXPECT_EQ(times, 20);
    EXPECT_TRUE(script.between({-1.0, -1.0}, 0.0, 1000.0).empty()) << "not begun";
    EXPECT_EQ(script.between({0.0, 0.0}, 0.0, 17.0).size(), 3u) << "a long frame leaves none out";
}

TEST(KioskScript, IsReadInOrderAndItsFaultsAreNamed) {
    const TemporaryFolder folder;
    write_text(folder / "s.json", R"({"schema": 1, "steps": [{"frame": 9, "picture": "end"},
        {"frame": 3, "act": "agree"}, {"frame": 9, "fault": "camera"}]})");
    const Script script = load_script(folder / "s.json");
    ASSERT_EQ(script.steps.size(), 3u);
    EXPECT_EQ(script.steps[0].action, Action::agree);
    EXPECT_EQ(script.at(9).size(), 2u);
    const auto refusal = [&](const char* text) {
        write_text(folder / "s.json", text);
        return error_of([&] { (void)load_script(folder / "s.json"); });
    };
    EXPECT_THAT(refusal(R"({"schema": 1, "steps": [{"frame": 1, "act": "agre"}]})"),
                HasSubstr("/steps/0/act"));
    EXPECT_THAT(refusal(R"({"schema": 1, "steps": [{"frame": 1, "fault": "flood"}]})"),
                HasSubstr("/steps/0/fault"));
    EXPECT_THAT(refusal(R"({"schema": 1, "steps": [{"frame": 1}]})"), HasSubstr("/steps/0"));
    EXPECT_THAT(refusal(R"({"schema": 1, "steps": [{"frame": 1, "picture": "../x"}]})"),
                HasSubstr("picture"));
}

TEST(KioskMetrics, IsPrometheusText) {
    Metrics metrics;
    metrics.frames = 12;
    metrics.count(Fault::camera);
    metrics.screen = ScreenName::mirror;
    metrics.latency_p95_s = 0.0425;
    const std::string text = prometheus_text(metrics);
    EXPECT_THAT(text, HasSubstr("\ntoile_kiosk_frames_total 12\n"));
    EXPECT_THAT(text, HasSubstr("\ntoile_kiosk_faults_total{kind=\"camera\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("\ntoile_kiosk_screen{name=\"mirror\"} 1\n"));
    EXPECT_THAT(text, HasSubstr("\ntoile_kiosk_latency_p95_seconds 0.0425\n"));
    // The format: comments, or a name, labels and a number; each metric announced before.
    const std::regex line(
        R"(# (HELP|TYPE) [a-z0-9_]+ .+|([a-z0-9_]+)(\{[a-z]+="[a-z_]+"\})? [0-9.e+-]+)");
    std::set<std::string> announced;
    std::istringstream in(text);
    for (std::string one; std::getline(in, one);) {
        std::smatch match;
        ASSERT_TRUE(std::regex_match(one, match, line)) << one;
        if (one.rfind("# TYPE ", 0) == 0) announced.insert(one.substr(7, one.find(' ', 7) - 7));
        if (one[0] != '#') {
            EXPECT_TRUE(announced.contains(match[2])) << one;
        }
    }
    EXPECT_EQ(text.back(), '\n');
}

} // namespace
} // namespace toile::test
