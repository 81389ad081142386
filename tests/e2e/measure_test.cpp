// toile measure as a user calls it: the table, the JSON, the pictures, and what it refuses.
#include "assets/files.h"
#include "imaging/image.h"
#include "support/mannequin.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

using testing::HasSubstr;

TEST(Measure, ATableNamesEveryMeasurementOfAnAvatar) {
    const ProgramResult result = run_toile({"measure", "woman"});
    ASSERT_EQ(result.status, 0) << result.output;
    EXPECT_GE(std::count(result.output.begin(), result.output.end(), '\n'), 70);
    EXPECT_THAT(result.output,
                testing::ContainsRegex("bust_girth +[0-9]+\\.[0-9] cm  confidence [01]\\.[0-9]+"));
}

TEST(Measure, OnlyWhatIsAskedForAsJson) {
    const ProgramResult result = run_toile({"measure", "man", "--json", "--measurement",
                                            "waist_girth", "--measurement", "inside_leg_length"});
    ASSERT_EQ(result.status, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output);
    ASSERT_EQ(json.at("measurements").size(), 2u);
    const double waist = json.at("measurements").at("waist_girth").at("value");
    EXPECT_TRUE(waist > 0.6 && waist < 1.1) << waist;
    EXPECT_GT(json.at("measurements").at("inside_leg_length").at("confidence"), 0.5);
}

TEST(Measure, ABodyFileMeasuresTheSameHoweverItStood) {
    const TemporaryFolder folder;
    const auto file = folder / "anna.json";
    ASSERT_EQ(run_toile({"avatar", "new", "--sex", "female", "--stature", "1.68", "--bust_girth",
                         "0.92", "--out", file.string()})
                  .status,
              0);
    const auto measured = [&] {
        const ProgramResult result = run_toile({"measure", file.string(), "--json"});
        EXPECT_EQ(result.status, 0) << result.output;
        return nlohmann::json::parse(result.output).at("measurements");
    };
    const auto rest = measured();
    EXPECT_NEAR(rest.at("stature").at("value").get<double>(), 1.68, 0.002);
    EXPECT_NEAR(rest.at("bust_girth").at("value").get<double>(), 0.92, 0.002);
    auto json = nlohmann::json::parse(std::ifstream(file));
    json["pose"] = {{"hips_position", {1.0, 0.9, -2.0}},
                    {"rotations", {{"leftUpperArm", {0.0, 0.0, 0.6, 0.8}}}}};
    std::ofstream(file) << json.dump();
    const auto posed = measured();
    for (const auto& [name, row] : rest.items())
        EXPECT_NEAR(posed.at(name).at("value").get<double>(), row.at("value").get<double>(), 0.002)
            << name;
}

/// The analytic figure as a scanner gives it: millimetres, turned, somewhere in the room.
void write_mannequin(const std::filesystem::path& file) {
    geometry::TriangleMesh scan = Mannequin().mesh(0.006f);
    const Eigen::AngleAxisf turn(0.5f, Vec3f::UnitY());
    for (Vec3f& p : scan.positions)
        p = 1000.0f * (turn * p + Vec3f(0.3f, 0.0f, -0.8f));
    assets::Scene scene;
    scene.meshes.emplace_back().primitives.emplace_back();
    scene.meshes[0].primitives[0].positions = scan.positions;
    scene.meshes[0].primitives[0].triangles = scan.triangles;
    scene.nodes.emplace_back().mesh = 0;
    assets::save_scene(scene, file);
}

// How near the fitted surface is, tests of scape_fit tell (within 2 mm). Here each tape must also
// be laid where it belongs, and the body be brought from its pose to rest. Neck and thigh are left
// out: a figure without a larynx and with a flat crotch has no place where their tapes belong.
TEST(Measure, AScanOfAnAnalyticFigureHasItsKnownGirths) {
    const TemporaryFolder folder;
    const auto file = folder / "mannequin.ply";
    write_mannequin(file);
    const ProgramResult result = run_toile({"measure", file.string(), "--json"});
    ASSERT_EQ(result.status, 0) << result.output;
    const auto measured =
        nlohmann::json::parse(result.output.substr(result.output.find('{'))).at("measurements");
    const auto value = [&](const char* name) {
        return measured.at(name).at("value").get<double>();
    };
    struct Known {
        const char* name;
        Stretch stretch;
        double within_m;
    };
    for (const Known& known : {Known{"bust_girth", Mannequin::kBust, 0.006},
                               {"waist_girth", Mannequin::kWaist, 0.003},
                               {"hip_girth", Mannequin::kHip, 0.006},
                               {"head_girth", Mannequin::kHead, 0.008},
                               {"calf_girth", Mannequin::kCalf, 0.003},
                               {"minimum_leg_girth", Mannequin::kShin, 0.003},
                               {"upper_arm_girth", Mannequin::kUpperArm, 0.003},
                               {"wrist_girth", Mannequin::kWrist, 0.003}}) {
        EXPECT_NEAR(value(known.name), known.stretch.girth(), known.within_m) << known.name;
        std::cout << known.name << ": " << 1000.0 * (value(known.name) - known.stretch.girth())
                  << " mm off\n";
    }
    EXPECT_NEAR(value("crotch_height"), static_cast<double>(Mannequin::kCrotch), 0.02);
    for (const auto& [name, stretch] : {std::pair{"bust_height", Mannequin::kBust},
                                        {"waist_height", Mannequin::kWaist},
                                        {"hip_height", Mannequin::kHip}}) {
        EXPECT_GT(value(name), static_cast<double>(stretch.from) - 0.01) << name;
        EXPECT_LT(value(name), static_cast<double>(stretch.to) + 0.01) << name;
    }
}

/// How red the reddest pixel of some columns is.
int reddest(const imaging::Image& image, int from = 0, int to = 1 << 20) {
    int most = 0;
    for (std::size_t at = 0; at < image.pixels.size(); at += 4) {
        const int x = static_cast<int>(at / 4) % image.width;
        if (x >= from && x < to) most = std::max(most, image.pixels[at] - image.pixels[at + 1]);
    }
    return most;
}

TEST(Measure, DrawsTheTapesAndTheirValues) {
    const TemporaryFolder folder;
    const auto picture = folder / "woman.png", sheet = folder / "sheet.png";
    const ProgramResult result = run_toile(
        {"measure", "woman", "--picture", picture.string(), "--views", "front", "--measurement",
         "waist_girth", "--measurement", "hip_girth", "--sheet", sheet.string()});
    ASSERT_EQ(result.status, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr(picture.string()));
    const imaging::Image drawn = imaging::load_image(picture);
    EXPECT_GT(drawn.width, 560); // the view, and the values beside it
    EXPECT_EQ(drawn.height, 800);
    EXPECT_GT(reddest(drawn), 80);
    EXPECT_GT(reddest(imaging::load_image(sheet)), 80);
}

TEST(Measure, ATapeThatIsHiddenFromOneSideIsDrawnFromTwo) {
    const TemporaryFolder folder;
    const auto drawn = [&](const char* name) {
        const auto sheet = folder / "sheet.png";
        const ProgramResult result =
            run_toile({"measure", "woman", "--measurement", name, "--sheet", sheet.string()});
        EXPECT_EQ(result.status, 0) << result.output;
        return imaging::load_image(sheet);
    };
    constexpr int kPicture = 220; // pixels, width of one
    for (const char* name : {"total_crotch_length", "waist_girth"}) {
        const imaging::Image sheet = drawn(name);
        EXPECT_GT(reddest(sheet, 0, kPicture), 80) << name;
        EXPECT_GT(reddest(sheet, kPicture, 2 * kPicture), 80) << name;
        EXPECT_LT(reddest(sheet, 2 * kPicture), 10) << name;
    }
    EXPECT_LT(reddest(drawn("back_waist_length"), kPicture), 10);
    EXPECT_LT(reddest(drawn("waist_breadth"), kPicture), 10); // through the body from all sides
}

TEST(Measure, SaysInOneLineWhatIsWrong) {
    const TemporaryFolder folder;
    const auto expect = [](std::vector<std::string> words, int status, const std::string& text) {
        words.insert(words.begin(), "measure");
        const ProgramResult result = run_toile(words);
        EXPECT_EQ(result.status, status) << result.output;
        EXPECT_THAT(result.output, HasSubstr(text));
        if (status == 1) {
            EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1)
                << result.output;
        }
    };
    expect({}, 2, "body");
    expect({"giant"}, 1, "no avatar 'giant'");
    expect({"woman", "--measurement", "waist_grith"}, 1, "did you mean 'waist_girth'");
    expect({"woman", "--picture", "a.gif"}, 2, "a.gif");
    expect({"woman", "--picture", "a.png", "--views", "inside"}, 2, "inside");
    expect({(folder / "none.json").string()}, 1, "none.json: no such file");
    const auto bad = folder / "bad.json";
    std::ofstream(bad) << R"({"schema": 1, "model": "adult", "model_version": "0.1.0",)"
                       << R"( "made_by": "measurements", "coefficients": []})";
    expect({bad.string()}, 1, "bad.json: the body was made with version 0.1.0");
    std::ofstream(bad) << R"({"schema": 1, "shoes": 42})";
    expect({bad.string()}, 1, "bad.json: ");
}

} // namespace
} // namespace toile::test
