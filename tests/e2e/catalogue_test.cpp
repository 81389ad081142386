// toile catalogue, as a shop calls it: made, gone on with, shared out, submitted to Slurm.
#include "imaging/image.h"
#include "support/json_schema.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/text_file.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class CatalogueTest : public testing::Test {
  protected:
    /// A plan of small quick pictures; `more` is laid over it.
    fs::path plan(const json& more = json::object()) {
        json j = {{"schema", 1},
                  {"garments", {"skirt"}},
                  {"bodies", {"woman", "man"}},
                  {"views", {"front"}},
                  {"picture", "90x120"},
                  {"quality", "fast"},
                  {"limits", {{"deep_fraction", 0.001}}}};
        j.update(more);
        EXPECT_THAT(JsonSchema("catalogue.schema.json").faults(j), IsEmpty());
        return write(j);
    }
    fs::path write(const json& j) {
        std::ofstream(folder_ / "plan.json") << j.dump();
        return folder_ / "plan.json";
    }
    ProgramResult make(const fs::path& plan, const std::vector<std::string>& more = {}) {
        std::vector<std::string> words = {"catalogue", plan.string(), "--out", out_.string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words);
    }

    TemporaryFolder folder_;
    fs::path out_ = folder_ / "out";
};

TEST_F(CatalogueTest, MakesEveryItemAndNamesTheOneThatCannotBeMade) {
    const ProgramResult result = make(plan({{"garments", {"skirt", "nosuch"}},
                                            {"bodies", {"woman"}},
                                            {"views", {"front", "back"}},
                                            {"glb", true}}));
    EXPECT_EQ(result.status, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr("nosuch_auto_woman_rest: no garment is called 'nosuch'"));
    EXPECT_THAT(result.output, HasSubstr("1 of 2 items in "));
    const fs::path item = out_ / "skirt_auto_woman_rest";
    for (const char* view : {"front.png", "back.png"})
        EXPECT_EQ(imaging::load_image(item / view).height, 120);
    EXPECT_NE(file_text(item / "front.png"), file_text(item / "back.png"));
    EXPECT_TRUE(fs::exists(item / "look.glb"));
    EXPECT_THAT(JsonSchema("fit.schema.json").faults(json::parse(file_text(item / "fit.json"))),
                IsEmpty());
    const json record = json::parse(file_text(item / "item.json"));
    EXPECT_EQ(record["worn"]["skirt"]["size"], "S");
    EXPECT_LE(record["figures"]["deep_fraction_max"].get<double>(), 0.001);
    const json results = json::parse(file_text(out_ / "results.json"));
    EXPECT_EQ(results["done"], 1);
    EXPECT_EQ(results["failed"], 1);
    EXPECT_THAT(file_text(out_ / "summary.md"),
                HasSubstr("- nosuch_auto_woman_rest: failed: no gar"));
    EXPECT_GT(imaging::load_image(out_ / "sheet-001.png").width, 2 * 90);
}

TEST_F(CatalogueTest, GoesOnWhereItWasAndTheResultIsTheSame) {
    const fs::path p = plan();
    ASSERT_EQ(make(p).status, 0);
    const std::string results = file_text(out_ / "results.json"),
                      sheet = file_text(out_ / "sheet-001.png");
    fs::remove_all(out_ / "skirt_auto_man_rest");
    std::ofstream(out_ / "skirt_auto_woman_rest" / "mark") << "kept";
    const ProgramResult again = make(p);
    EXPECT_EQ(again.status, 0) << again.output;
    EXPECT_THAT(again.output, HasSubstr("1 items were there already"));
    EXPECT_THAT(again.output, HasSubstr("[1/1] skirt_auto_man_rest"));
    EXPECT_TRUE(fs::exists(out_ / "skirt_auto_woman_rest" / "mark"));
    EXPECT_EQ(file_text(out_ / "results.json"), results);
    EXPECT_EQ(file_text(out_ / "sheet-001.png"), sheet);
    // A damaged record, or other inputs, and it is made again.
    std::ofstream(out_ / "skirt_auto_man_rest" / "item.json") << "{";
    const ProgramResult other = make(plan({{"picture", "60x80"}}));
    EXPECT_THAT(other.output, HasSubstr("item.json: is damaged and will be made again"));
    EXPECT_THAT(other.output, HasSubstr("[2/2]"));
    EXPECT_FALSE(fs::exists(out_ / "skirt_auto_woman_rest" / "mark"));
}

TEST_F(CatalogueTest, SharesPutTogetherAreTheWhole) {
    const fs::path p = plan();
    ASSERT_EQ(make(p).status, 0);
    const std::string results = file_text(out_ / "results.json"),
                      sheet = file_text(out_ / "sheet-001.png");
    out_ = folder_ / "shared";
    ASSERT_EQ(make(p, {"--share", "1/2"}).status, 0);
    EXPECT_FALSE(fs::exists(out_ / "skirt_auto_woman_rest"));
    const ProgramResult half = make(p, {"--merge"});
    EXPECT_EQ(half.status, 1);
    EXPECT_THAT(half.output, HasSubstr("1 not made"));
    EXPECT_THAT(file_text(out_ / "summary.md"), HasSubstr("- skirt_auto_woman_rest: not made"));
    ASSERT_EQ(make(p, {"--share", "0/2"}).status, 0);
    ASSERT_EQ(make(p, {"--merge"}).status, 0);
    EXPECT_EQ(file_text(out_ / "results.json"), results);
    EXPECT_EQ(file_text(out_ / "sheet-001.png"), sheet);
}

TEST_F(CatalogueTest, SingleLooksFollowTheCombinations) {
    const fs::path p = plan({{"looks",
                              {{{"garments", "skirt"}, {"body", "mannequin"}, {"size", "M"}},
                               {{"garments", "skirt"}, {"body", "man"}, {"size", "L"}}}}});
    const ProgramResult list = make(p, {"--list"});
    EXPECT_EQ(list.output, "skirt_auto_woman_rest\nskirt_auto_man_rest\n"
                           "skirt_M_mannequin_rest\nskirt_L_man_rest\n");
    const json alone = {{"schema", 1}, {"looks", {{{"garments", "skirt"}, {"body", "man"}}}}};
    EXPECT_THAT(JsonSchema("catalogue.schema.json").faults(alone), IsEmpty());
    EXPECT_EQ(make(write(alone), {"--list"}).output, "skirt_auto_man_rest\n");
    EXPECT_THAT(make(write({{"schema", 1}, {"looks", {{{"body", "man"}}}}})).output,
                HasSubstr("garments"));
}

TEST_F(CatalogueTest, WhatIsBeyondTheLimitsIsNamed) {
    const ProgramResult result =
        make(plan({{"bodies", {"woman"}}, {"limits", {{"strain_rms", 0.0}}}}));
    EXPECT_EQ(result.status, 0) << "it was made all the same";
    EXPECT_THAT(result.output, HasSubstr("1 beyond the plan's limits"));
    EXPECT_THAT(file_text(out_ / "summary.md"),
                HasSubstr("- skirt_auto_woman_rest: strain_rms 0.0"));
}

TEST_F(CatalogueTest, SlurmMakesTheSame) {
    const std::string slurm = std::string(TOILE_SOURCE_DIR) + "/tests/e2e/one_machine_slurm";
    const fs::path p = plan();
    const ProgramResult submitted =
        run_program({slurm, toile_program(), "catalogue", p.string(), "--out", out_.string(),
                     "--slurm", "--slurm-tasks", "2", "--slurm-cpus", "1", "--wait"});
    if (submitted.status == 77) GTEST_SKIP() << "Slurm is not installed";
    ASSERT_EQ(submitted.status, 0) << submitted.output << file_text(out_ / "merge.log");
    EXPECT_THAT(submitted.output, HasSubstr("2 tasks make the items of"));
    const std::string results = file_text(out_ / "results.json");
    EXPECT_EQ(json::parse(results)["done"], 2);
    EXPECT_THAT(file_text(out_ / "make-1.log"), HasSubstr("[1/1] skirt_auto_man_rest"));
    out_ = folder_ / "here";
    ASSERT_EQ(make(p).status, 0);
    EXPECT_EQ(file_text(out_ / "results.json"), results);
}

TEST_F(CatalogueTest, WithoutSlurmItSaysSo) {
    const ProgramResult result = run_program(
        {toile_program(), "catalogue", plan().string(), "--out", out_.string(), "--slurm"},
        "PATH=/nowhere");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.output, HasSubstr("there is no sbatch here: install Slurm"));
    EXPECT_TRUE(fs::exists(out_ / "make.sbatch"));
}

TEST_F(CatalogueTest, BadPlansAreRefusedInOneLine) {
    const auto refused = [&](const json& more, const char* text) {
        json j = {{"schema", 1}, {"garments", {"skirt"}}, {"bodies", {"woman"}}};
        j.update(more);
        const ProgramResult result = make(write(j));
        EXPECT_NE(result.status, 0) << text;
        EXPECT_THAT(result.output, HasSubstr(text));
        EXPECT_FALSE(fs::exists(out_));
    };
    refused({{"garment", "tee"}}, "garment");
    refused({{"bodies", json::array()}}, "bodies: is empty");
    refused({{"bodies", {"woman", "woman"}}}, "bodies: names one thing twice");
    refused({{"views", {"inside"}}}, "inside");
    refused({{"picture", "wide"}}, "size 'wide' is not of the form");
    refused({{"limits", {{"deep", 1}}}}, "limits/deep");
    refused({{"poses", {"a/walk.bvh", "b/walk.bvh"}}},
            "two items would be called skirt_auto_woman_walk");
    EXPECT_THAT(make(folder_ / "none.json").output, HasSubstr("none.json"));
    EXPECT_EQ(make(plan(), {"--share", "2/2"}).status, 2);
    EXPECT_EQ(make(plan(), {"--only", "coat"}).status, 2);
}

TEST_F(CatalogueTest, APoseOutsideOfTheMotionIsNamed) {
    const ProgramResult result =
        make(plan({{"bodies", {"woman"}},
                   {"poses", {std::string(TOILE_SOURCE_DIR) + "/avatars/motions/turn.json@99"}}}));
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.output, HasSubstr("turn.json lasts "));
}

} // namespace
} // namespace toile::test
