// Bodies on the command line: made from numbers, found in scans and depth pictures, measured,
// dressed.
#include "core/bytes.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

nlohmann::json json_of(const fs::path& file) {
    const auto bytes = read_bytes(file, 64u << 20);
    return nlohmann::json::parse(bytes.begin(), bytes.end());
}

/// The object in a command's output, past what it says on standard error.
nlohmann::json json_in(const std::string& output) {
    const auto from = output.find('{'), to = output.rfind('}');
    if (from == std::string::npos || to == std::string::npos) return {};
    return nlohmann::json::parse(output.substr(from, to - from + 1));
}

double value(const nlohmann::json& body, const char* name) {
    return body.at("measurements").at(name).at("value");
}

class BodyTest : public testing::Test {
  protected:
    [[nodiscard]] std::string at(const std::string& name) const {
        return (folder_ / name).string();
    }
    TemporaryFolder folder_;
};

TEST_F(BodyTest, AScanIsFittedMeasuredAndWrittenBack) {
    // The mannequin is of another training run than the body space: nobody in it.
    const std::string scan = std::string(TOILE_SOURCE_DIR) + "/avatars/mannequin/mannequin.glb";
    const ProgramResult fit =
        run_toile({"fit", "--scan", scan, "--out", at("a.json"), "--mesh", at("a.ply")});
    ASSERT_EQ(fit.status, 0) << fit.output;
    const auto body = json_of(folder_ / "a.json");
    EXPECT_EQ(body.at("fit").at("unit"), "m");
    const ProgramResult shown = run_toile({"avatar", "show", "mannequin", "--json"});
    const auto known = json_in(shown.output).at("measurements");
    for (const char* name : {"stature", "bust_girth", "waist_girth", "hip_girth"})
        EXPECT_NEAR(value(body, name), known.at(name).get<double>(), 0.008) << name;
    // Measuring the file, and the scan itself, gives the same again.
    const ProgramResult measured = run_toile({"measure", at("a.json"), "--json"});
    ASSERT_EQ(measured.status, 0) << measured.output;
    const auto again = json_in(measured.output);
    EXPECT_NEAR(value(again, "hip_girth"), value(body, "hip_girth"), 2e-4);
    EXPECT_GE(again.at("measurements").size(), 30u);
    const ProgramResult direct =
        run_toile({"measure", at("a.ply"), "--json", "--measurement", "waist_girth"});
    ASSERT_EQ(direct.status, 0) << direct.output;
    EXPECT_NEAR(value(json_in(direct.output), "waist_girth"), value(body, "waist_girth"), 0.004);
}

TEST_F(BodyTest, FourDepthCamerasGiveABody) {
    std::string cameras;
    for (const char* place : {"[0,1,2.4]", "[2.4,1,0]", "[0,1,-2.4]", "[-2.4,1,0]"})
        cameras += std::string(cameras.empty() ? "" : ",") + R"({"name": "c)" +
                   std::to_string(cameras.size()) + R"(", "mount": "upright", "position": )" +
                   place + R"(, "look_at": [0, 0.9, 0]})";
    write_text(folder_ / "scene.json",
               R"({"schema": 1, "color": false, "people": [{"body": {"avatar": "mannequin"}}],
                   "scene": {"walls": [{"position": [0, 0, -3.2]}]}, "cameras": [)" +
                   cameras + "]}");
    const ProgramResult fit =
        run_toile({"fit", "--source", "simulated:" + at("scene.json"), "--out", at("b.json")});
    ASSERT_EQ(fit.status, 0) << fit.output;
    const auto body = json_of(folder_ / "b.json");
    EXPECT_EQ(body.at("fit").at("cameras"), 4);
    const auto known =
        json_in(run_toile({"avatar", "show", "mannequin", "--json"}).output).at("measurements");
    for (const char* name : {"bust_girth", "waist_girth", "hip_girth"})
        EXPECT_NEAR(value(body, name), known.at(name).get<double>(), 0.025) << name;
}

TEST_F(BodyTest, ABodyFromNumbersIsMeasuredDrawnAndDressed) {
    ASSERT_EQ(run_toile({"avatar", "new", "--sex", "female", "--stature", "1.70", "--waist_girth",
                         "0.75", "--out", at("n.json")})
                  .status,
              0);
    const ProgramResult measured =
        run_toile({"measure", at("n.json"), "--picture", at("n.png"), "--json"});
    ASSERT_EQ(measured.status, 0) << measured.output;
    const auto json = json_in(measured.output);
    EXPECT_NEAR(value(json, "stature"), 1.70, 0.002);
    EXPECT_NEAR(value(json, "waist_girth"), 0.75, 0.002);
    EXPECT_GT(fs::file_size(folder_ / "n.png"), 20000u);
    const ProgramResult dressed =
        run_toile({"tryon", "--body", at("n.json"), "--garment", "t-shirt", "--out", at("look.png"),
                   "--size", "auto", "--report", at("report.json")});
    ASSERT_EQ(dressed.status, 0) << dressed.output;
    EXPECT_LT(json_of(folder_ / "report.json").at("skin").at("visible_fraction_max").get<double>(),
              0.01);
}

TEST_F(BodyTest, WhatCannotBeDoneIsSaidInOneLine) {
    const auto fails = [&](std::vector<std::string> words, int status, const std::string& why) {
        const ProgramResult result = run_toile(words);
        EXPECT_EQ(result.status, status) << result.output;
        EXPECT_THAT(result.output, HasSubstr(why));
    };
    fails({"fit", "--out", at("x.json")}, 2, "--scan FILE or --source URI");
    fails({"fit", "--scan", at("none.ply"), "--out", at("x.json")}, 1, "none.ply");
    const std::string shirt = std::string(TOILE_SOURCE_DIR) + "/garments/t-shirt/t-shirt.glb";
    if (fs::exists(shirt)) fails({"fit", "--scan", shirt, "--out", at("x.json")}, 1, "person");
    fails({"fit", "--scan", shirt, "--out", at("x.ply")}, 2, ".json");
    fails({"measure", "nobody"}, 1, "nobody");
    fails({"measure", "woman", "--measurement", "waist"}, 1, "waist");
    write_text(folder_ / "broken.json", "{}");
    fails({"measure", at("broken.json")}, 1, "schema");
    fails({"tryon", "--body", at("broken.json"), "--garment", "t-shirt", "--out", at("x.png")}, 1,
          "schema");
    EXPECT_FALSE(fs::exists(folder_ / "x.json"));
}

} // namespace
} // namespace toile::test
