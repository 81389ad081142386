// The command that a plugin adds: trains, stops cleanly, goes on.
#include "core/bytes.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>

namespace toile::test {
namespace {

using testing::HasSubstr;

std::vector<std::string> training(const std::string& out) {
    return {"avatar",   "train-parts",
            "--model",  std::string(TOILE_SOURCE_DIR) + "/avatars/adult",
            "--frames", "150",
            "--people", "4",
            "--trees",  "2",
            "--depth",  "4",
            "--out",    out};
}

std::string quoted(const std::vector<std::string>& words) {
    std::string out = "'" + toile_program() + "'";
    for (const std::string& word : words)
        out += " '" + word + "'";
    return out;
}

TEST(TrainParts, IsListedAndExplained) {
    EXPECT_THAT(run_toile({"avatar", "--help"}).output, HasSubstr("train-parts"));
    const ProgramResult help = run_toile({"avatar", "train-parts", "--help"});
    EXPECT_EQ(help.status, 0) << help.output;
    EXPECT_THAT(help.output, HasSubstr("--checkpoint"));
    EXPECT_THAT(help.output, HasSubstr("Example: toile avatar train-parts"));
}

TEST(TrainParts, WrongOptionsAreWrongUsageAndFailedWorkIsNot) {
    const auto status = [](std::vector<std::string> words, const std::string& more,
                           const std::string& value) {
        words.insert(words.end(), {more, value});
        return run_toile(words).status;
    };
    EXPECT_EQ(run_toile({"avatar", "train-parts"}).status, 2);
    EXPECT_EQ(status(training("a.forest"), "--depth", "31"), 2);
    EXPECT_EQ(status(training("a.forest"), "--colour", "red"), 2);
    EXPECT_EQ(status(training("a.forest"), "--motions", "/no/such/file.bvh"), 2);
    const ProgramResult failed = run_toile(training("/no/such/folder/a.forest"));
    EXPECT_EQ(failed.status, 1);
    EXPECT_THAT(failed.output, HasSubstr("/no/such/folder"));
}

TEST(TrainParts, StoppedAndCalledAgainItGivesTheSameBytes) {
    const TemporaryFolder folder;
    const auto whole = folder / "whole.forest", resumed = folder / "resumed.forest";
    const auto checkpoint = folder / "parts.checkpoint";
    const ProgramResult once = run_toile(training(whole.string()));
    ASSERT_EQ(once.status, 0) << once.output;
    EXPECT_THAT(once.output, HasSubstr("2 trees"));

    auto words = training(resumed.string());
    words.insert(words.end(), {"--checkpoint", checkpoint.string(), "--threads", "2"});
    // Interrupted as soon as the first level is kept.
    const ProgramResult stopped = run_program(
        {"sh", "-c",
         "set -m; " + quoted(words) + " & pid=$!; for i in $(seq 3000); do [ -e '" +
             checkpoint.string() + "' ] && break; sleep 0.01; done; kill -INT $pid; wait $pid"});
    EXPECT_EQ(stopped.status, 1) << stopped.output;
    EXPECT_FALSE(std::filesystem::exists(resumed));
    ASSERT_TRUE(std::filesystem::exists(checkpoint));
    const ProgramResult again = run_toile(words);
    ASSERT_EQ(again.status, 0) << again.output;
    EXPECT_EQ(read_bytes(resumed, 1 << 20), read_bytes(whole, 1 << 20));
}

} // namespace
} // namespace toile::test
