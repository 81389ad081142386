// Garments from sewing patterns on the command line.
#include "core/bytes.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class DraftTest : public testing::Test {
  protected:
    [[nodiscard]] std::string at(const std::string& name) const {
        return (folder_ / name).string();
    }
    TemporaryFolder folder_;
};

TEST_F(DraftTest, AFreeSewingDesignIsMadeAndWornTheSameEachTime) {
    const std::vector<std::string> draft = {"garment", "draft", "tank-top", "--size", "M",
                                            "--edge",  "0.035", "--id",     "a"};
    for (const char* out : {"a", "b"}) {
        auto command = draft;
        command.insert(command.end(), {"--out", at(out) + "/a"});
        const ProgramResult made = run_toile(command);
        ASSERT_EQ(made.status, 0) << made.output;
    }
    EXPECT_EQ(read_bytes(folder_ / "a/a/a-M.glb", 8u << 20),
              read_bytes(folder_ / "b/a/a-M.glb", 8u << 20));
    const ProgramResult worn = run_toile({"tryon", "--body", "women-m", "--garment", at("a/a"),
                                          "--out", at("a.png"), "--picture", "320x320"});
    EXPECT_EQ(worn.status, 0) << worn.output;
    EXPECT_TRUE(fs::exists(folder_ / "a.png"));
}

TEST_F(DraftTest, ThePiecesOfADesignAreListed) {
    const ProgramResult list = run_toile({"garment", "draft", "tank-top", "--list"});
    ASSERT_EQ(list.status, 0) << list.output;
    EXPECT_THAT(list.output, HasSubstr("strapLeft"));
    EXPECT_THAT(list.output, HasSubstr("on the outline"));
}

// Two squares sewn at the sides and the shoulders; `width_cm` wide.
std::string garmentcode(const int width_cm) {
    const std::string w = std::to_string(width_cm);
    const std::string h = std::to_string(width_cm / 2);
    const auto panel = [&](const char* name, const char* z) {
        return std::string("\"") + name + R"(": {"translation": [-)" + h + ", 85, " + z +
               R"(], "rotation": [0, 0, 0], "vertices": [[0, 0], [)" + w + ", 0], [" + w +
               R"(, 35], [0, 35]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
                  {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
    };
    return R"({"pattern": {"panels": {)" + panel("front", "20") + ", " + panel("back", "-20") +
           R"(}, "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 1}],
               [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 3}]]},
               "properties": {"units_in_meter": 100}})";
}

TEST_F(DraftTest, AGarmentCodePatternIsMadeAndOneThatIsTooNarrowSaysSo) {
    write_text(folder_ / "tube.json", garmentcode(60));
    const ProgramResult made =
        run_toile({"garment", "draft", at("tube.json"), "--body", "woman", "--kind", "skirt",
                   "--edge", "0.03", "--out", at("tube")});
    EXPECT_EQ(made.status, 0) << made.output;
    write_text(folder_ / "sock.json", garmentcode(14));
    const ProgramResult sock = run_toile({"garment", "draft", at("sock.json"), "--body", "woman",
                                          "--edge", "0.03", "--out", at("sock")});
    EXPECT_EQ(sock.status, 1);
    EXPECT_THAT(sock.output, HasSubstr("stretched by"));
    EXPECT_THAT(sock.output, HasSubstr("panel"));
    EXPECT_THAT(sock.output, HasSubstr("refused.json"));
    EXPECT_FALSE(fs::exists(folder_ / "sock" / "garment.json"));
    const auto bytes = read_bytes(folder_ / "sock" / "refused.json", 1u << 16);
    const auto kept = nlohmann::json::parse(bytes.begin(), bytes.end());
    EXPECT_EQ(kept["edge_m"], 0.03);
    EXPECT_FALSE(kept["panel"].get<std::string>().empty());
    EXPECT_GT(kept["result"]["strain"], kept["drape"]["most_strain"]);
}

TEST_F(DraftTest, WhatCannotBeDraftedIsNamed) {
    const ProgramResult none = run_toile({"garment", "draft", "spacesuit", "--out", at("a")});
    EXPECT_EQ(none.status, 2);
    EXPECT_THAT(none.output, HasSubstr("there is no recipe 'spacesuit'; there are coat"));
    const ProgramResult size =
        run_toile({"garment", "draft", "tank-top", "--size", "7", "--out", at("a")});
    EXPECT_EQ(size.status, 2);
    EXPECT_THAT(size.output, HasSubstr("is none of XS"));
    write_text(folder_ / "wrong.json", "{\"schema\": 1}");
    const ProgramResult wrong = run_toile({"garment", "draft", at("wrong.json"), "--out", at("a")});
    EXPECT_EQ(wrong.status, 1);
    EXPECT_THAT(wrong.output, HasSubstr("wrong.json"));
}

} // namespace
} // namespace toile::test
