// Exit statuses and one-line errors of the command line.
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

using testing::HasSubstr;

void expect_failure(const std::vector<std::string>& words, int status, const std::string& text) {
    const ProgramResult result = run_toile(words);
    EXPECT_EQ(result.status, status) << result.output;
    EXPECT_THAT(result.output, HasSubstr(text));
}

void expect_one_line(const std::vector<std::string>& words, const std::string& text) {
    const ProgramResult result = run_toile(words);
    EXPECT_EQ(result.status, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr(text));
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
}

TEST(CommandLine, HelpAndVersionSucceed) {
    EXPECT_EQ(run_toile({"--help"}).status, 0);
    const ProgramResult version = run_toile({"--version"});
    EXPECT_EQ(version.status, 0);
    EXPECT_THAT(version.output, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(CommandLine, EveryCommandHasHelpWithAnExample) {
    for (const char* command :
         {"mirror", "tryon", "compare", "view", "measure", "fit", "catalogue", "report", "bench"}) {
        const ProgramResult help = run_toile({command, "--help"});
        EXPECT_EQ(help.status, 0) << command;
        EXPECT_THAT(help.output, HasSubstr("Example: toile")) << command;
    }
}

TEST(CommandLine, BenchTellsEveryStageAgainstItsBaseline) {
    const TemporaryFolder folder;
    const std::string file = (folder / "bench.json").string();
    const ProgramResult result = run_toile(
        {"bench", "--garment", "skirt", "--frames", "3", "--picture", "96x96", "--json", file});
    ASSERT_EQ(result.status, 0) << result.output;
    std::ifstream in(file);
    const auto json = nlohmann::json::parse(in);
    EXPECT_EQ(json["frames"], 3);
    for (const char* stage : {"skinning", "targets", "cloth", "surfaces", "drawing", "compute"}) {
        EXPECT_THAT(result.output, HasSubstr(stage));
        const auto& one = json["stages"][stage];
        EXPECT_NEAR(one["ratio"].get<double>(),
                    one["median_ms"].get<double>() / json["baseline_ms"].get<double>(), 1e-9);
    }
}

TEST(CommandLine, WrongUsageIsStatusTwo) {
    expect_failure({}, 2, "subcommand");
    expect_failure({"fly"}, 2, "fly");
    expect_failure({"tryon", "--out", "look.png"}, 2, "--garment");
    expect_failure({"tryon", "--garment", "skirt", "--out", "look.jpg"}, 2, "look.jpg");
    expect_failure({"tryon", "--garment", "skirt", "--out", "a.png", "--views", "inside"}, 2,
                   "inside");
    expect_failure({"tryon", "--garment", "skirt,skirt", "--out", "a.png"}, 2, "named twice");
    expect_failure({"tryon", "--garment", "skirt", "--out", "a.png", "--picture", "0x5"}, 2, "0x5");
    expect_failure({"mirror", "--source", "kinect-log:a.csv", "--garment", "skirt", "--headless"},
                   2, "--out");
}

TEST(CommandLine, FailedWorkIsOneLineAndStatusOne) {
    expect_one_line({"tryon", "--garment", "cape", "--out", "a.png"}, "cape");
    expect_one_line({"tryon", "--body", "giant", "--garment", "skirt", "--out", "a.png"}, "giant");
    expect_one_line({"tryon", "--garment", "skirt", "--size", "XXXL", "--out", "a.png"}, "XXXL");
    expect_one_line({"tryon", "--garment", "skirt", "--pose", "missing.json", "--out", "a.png"},
                    "missing.json");
    expect_one_line({"--plugins", "/no/such/folder", "plugin", "list"}, "/no/such/folder");
}

TEST(CommandLine, ASourceThatCannotBeReadIsNamed) {
    const TemporaryFolder folder;
    const std::vector<std::string> rest = {"--garment", "skirt", "--headless", "--out",
                                           (folder / "out").string()};
    const auto mirror = [&](const std::string& uri) {
        std::vector<std::string> words = {"mirror", "--source", uri};
        words.insert(words.end(), rest.begin(), rest.end());
        return run_toile(words);
    };
    EXPECT_EQ(mirror("wave.csv").status, 2);
    EXPECT_THAT(mirror("telepathy:x").output, HasSubstr("telepathy"));
    EXPECT_THAT(mirror("kinect-log:" + (folder / "none.csv").string()).output,
                HasSubstr("none.csv"));

    const auto bad = folder / "bad.csv";
    std::ofstream(bad) << "1,2,3\n";
    const ProgramResult result = mirror("kinect-log:" + bad.string());
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.output, HasSubstr("bad.csv"));
    EXPECT_THAT(result.output, HasSubstr("1"));
}

} // namespace
} // namespace toile::test
