// tryon --fit and --fit-map, as a shop calls them; up to four garments together.
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

class FitReportTest : public testing::Test {
  protected:
    ProgramResult tryon(const std::string& garments, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"tryon",     "--garment", garments,    "--out", png_,
                                          "--picture", "180x240",   "--quality", "fast"};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words);
    }
    json fit(const std::string& garments, std::vector<std::string> more) {
        more.insert(more.end(), {"--fit", fit_});
        const ProgramResult result = tryon(garments, more);
        EXPECT_EQ(result.status, 0) << result.output;
        output_ = result.output;
        return json::parse(file_text(fit_));
    }
    static const json& row(const json& list, const char* key, const std::string& value) {
        for (const json& one : list)
            if (one[key] == value) return one;
        throw std::runtime_error("no " + value + " in " + list.dump());
    }
    /// A shipped garment under another id and in another layer.
    std::string copy(const std::string& garment, const std::string& id, int layer) {
        const fs::path to = folder_ / id;
        fs::copy(fs::path(TOILE_SOURCE_DIR) / "garments" / garment, to);
        json j = json::parse(file_text(to / "garment.json"));
        j["id"] = id;
        j["layer"] = layer;
        std::ofstream(to / "garment.json") << j.dump();
        return to.string();
    }

    TemporaryFolder folder_;
    std::string png_ = (folder_ / "look.png").string();
    std::string fit_ = (folder_ / "fit.json").string();
    std::string output_;
};

TEST_F(FitReportTest, TellsHowEachGarmentFits) {
    const json j = fit("t-shirt,skirt", {"--body", "woman"});
    EXPECT_THAT(JsonSchema("fit.schema.json").faults(j), IsEmpty());
    EXPECT_LE(j["contact"]["deep_fraction"].get<double>(), 0.001);
    EXPECT_LE(j["contact"]["self_intersections"].get<double>(), 0.002);
    EXPECT_LE(j["strain"]["rms"].get<double>(), 0.04);
    EXPECT_TRUE(j["failures"].empty()) << j["failures"];
    ASSERT_EQ(j["garments"].size(), 2u);
    for (const json& garment : j["garments"]) {
        const auto count = garment["vertices"]["count"].get<std::size_t>();
        EXPECT_GT(count, 1000u);
        for (const char* list : {"ease_m", "strain_warp", "strain_weft", "pressure_pa"})
            EXPECT_EQ(garment["vertices"][list].size(), count) << list;
        EXPECT_EQ(garment["recommended_size"], garment["size"]) << "--size auto takes the advice";
        EXPECT_THAT(output_, HasSubstr(garment["id"].get<std::string>() + ": " +
                                       garment["size"].get<std::string>()));
        for (const json& m : garment["measurements"])
            EXPECT_NEAR(m["ease_m"].get<double>(),
                        m["garment_m"].get<double>() - m["body_m"].get<double>(), 1.5e-4);
        for (const json& region : garment["regions"]) {
            EXPECT_EQ(region["ease_m"],
                      row(garment["measurements"], "name", region["measurement"])["ease_m"]);
            EXPECT_EQ(region["verdict"], "as_intended") << "S was made on this body";
        }
    }
    const json& shirt = row(j["garments"], "id", "t-shirt");
    EXPECT_NO_THROW((void)row(shirt["regions"], "region", "chest"));
    EXPECT_NO_THROW((void)row(shirt["lengths"], "name", "arm_length"));
    EXPECT_NO_THROW((void)row(row(j["garments"], "id", "skirt")["regions"], "region", "hip"));
}

TEST_F(FitReportTest, ASizeTooSmallIsTightAndALargerOneIsAdvised) {
    const json j = fit("skirt", {"--body", "man", "--size", "S"});
    const json& skirt = j["garments"][0];
    EXPECT_EQ(skirt["size"], "S");
    EXPECT_EQ(skirt["recommended_size"], "L");
    const json& waist = row(skirt["regions"], "region", "waist");
    EXPECT_EQ(waist["verdict"], "too_tight");
    EXPECT_GT(waist["pressure_p95_pa"].get<double>(), 1000.0);
    EXPECT_THAT(skirt["reasons"].dump(), HasSubstr("in M the waist has "));
    const json& eases = row(skirt["measurements"], "name", "waist_girth")["ease_by_size_m"];
    EXPECT_LT(eases["S"], eases["M"]);
    EXPECT_LT(eases["M"], eases["L"]);
    EXPECT_NEAR(eases["S"].get<double>(), waist["ease_m"].get<double>(), 1e-9);
}

TEST_F(FitReportTest, TheMakersEaseClassDecidesWhereItIsGiven) {
    const std::string coat = copy("t-shirt", "coat", 3);
    json package = json::parse(file_text(fs::path(coat) / "garment.json"));
    package["ease_class"] = {{"chest", "very_loose"}, {"waist", "fitted"}};
    std::ofstream(fs::path(coat) / "garment.json") << package.dump();
    const json j = fit(coat, {"--body", "woman"});
    const json& regions = j["garments"][0]["regions"];
    EXPECT_EQ(row(regions, "region", "chest")["ease_class_from"], "garment");
    EXPECT_EQ(row(regions, "region", "chest")["intended_ease_m"], 0.15);
    EXPECT_EQ(row(regions, "region", "waist")["verdict"], "too_loose");
    EXPECT_EQ(row(regions, "region", "hip")["ease_class_from"], "design");
}

TEST_F(FitReportTest, AnAlteredGarmentKeepsItsRoomOnAnotherBody) {
    const std::string altered = (folder_ / "altered").string();
    const ProgramResult made = run_toile({"garment", "alter", "pencil-skirt", "--size", "M",
                                          "--body", "women-xl", "--out", altered});
    ASSERT_EQ(made.status, 0) << made.output;
    EXPECT_THAT(made.output, testing::Not(HasSubstr("still to mend")));
    EXPECT_EQ(run_toile({"garment", "check", altered}).status, 0);
    const json before = fit("pencil-skirt", {"--body", "women-m", "--size", "M"});
    const json after = fit(altered, {"--body", "women-xl"});
    for (const char* girth : {"waist_girth", "hip_girth"}) {
        const json& a = row(before["garments"][0]["measurements"], "name", girth);
        const json& b = row(after["garments"][0]["measurements"], "name", girth);
        EXPECT_GT(b["body_m"].get<double>(), a["body_m"].get<double>() + 0.07);
        EXPECT_NEAR(b["ease_m"].get<double>(), a["ease_m"].get<double>(), 0.015) << girth;
    }
    EXPECT_LE(after["strain"]["rms"].get<double>(), 0.03);
    const ProgramResult again =
        run_toile({"garment", "alter", "pencil-skirt", "--body", "women-xl", "--out", altered});
    EXPECT_EQ(again.status, 1);
    EXPECT_THAT(again.output, HasSubstr("holds a garment.json already"));
}

TEST_F(FitReportTest, OneThreadAndTwoWriteTheSameBytes) {
    (void)fit("t-shirt", {"--fit-map", "ease", "--threads", "1"});
    const std::string first = file_text(fit_), picture = file_text(png_);
    (void)fit("t-shirt", {"--fit-map", "ease", "--threads", "2"});
    EXPECT_TRUE(first == file_text(fit_));
    EXPECT_TRUE(picture == file_text(png_));
}

TEST_F(FitReportTest, MapsStandBesideALegendInEveryView) {
    ASSERT_EQ(tryon("t-shirt", {"--views", "front,back"}).status, 0);
    const imaging::Image plain = imaging::load_image(png_);
    std::vector<imaging::Image> maps;
    for (const char* map : {"ease", "strain"}) {
        const ProgramResult result = tryon("t-shirt", {"--views", "front,back", "--fit-map", map});
        ASSERT_EQ(result.status, 0) << result.output;
        maps.push_back(imaging::load_image(png_));
        EXPECT_GT(maps.back().width, plain.width) << "no legend";
        EXPECT_EQ(maps.back().height, plain.height);
    }
    EXPECT_NE(maps[0].pixels, maps[1].pixels);
}

TEST_F(FitReportTest, AMovingMapHasALegendToo) {
    const std::string motion = std::string(TOILE_SOURCE_DIR) + "/avatars/motions/turn.json";
    png_ = (folder_ / "frames").string();
    const ProgramResult result =
        tryon("skirt", {"--animation", motion, "--frames", "2", "--fit-map", "strain"});
    ASSERT_EQ(result.status, 0) << result.output;
    EXPECT_GT(imaging::load_image(folder_ / "frames/000001.png").width, 180);
}

TEST_F(FitReportTest, FourGarmentsAreWornTogetherInTheirLayers) {
    const std::string coat = copy("t-shirt", "coat", 5);
    const std::string apron = copy("skirt", "apron", 2);
    const json j = fit(coat + ",t-shirt," + apron + ",skirt", {"--body", "woman"});
    std::vector<std::string> order;
    for (const json& garment : j["garments"])
        order.push_back(garment["id"]);
    EXPECT_THAT(order, testing::ElementsAre("skirt", "t-shirt", "apron", "coat"));
}

TEST_F(FitReportTest, BadCallsAreRefusedInOneLine) {
    const auto refused = [&](const std::string& garments, const std::vector<std::string>& more,
                             int status, const char* text) {
        const ProgramResult result = tryon(garments, more);
        EXPECT_EQ(result.status, status) << result.output;
        EXPECT_THAT(result.output, HasSubstr(text));
    };
    refused("skirt", {"--fit-map", "pink"}, 2, "--fit-map 'pink': there are ease and strain");
    refused("a,b,c,d,e", {}, 2, "--garment names 5 garments; at most 4 are worn together");
    refused("skirt", {"--animation", "walk.json", "--fit", fit_}, 2, "--fit tells how clothes fit");
    refused("skirt", {"--fit", (folder_ / "no/such/fit.json").string()}, 1,
            "the fit report cannot be written");
}

} // namespace
} // namespace toile::test
