// fit.json of a report made up here, and the schemas of garments.
#include "garment/fit_file.h"

#include "core/error.h"
#include "support/json_schema.h"
#include "support/temporary_folder.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::garment {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

FitReport small_report() {
    GarmentFit fit;
    fit.id = "skirt";
    fit.name = "Skirt";
    fit.size = "M";
    fit.sizes = {"S", "M"};
    fit.recommended_size = "M";
    fit.between = "S";
    fit.reasons = {"between S and M"};
    fit.girths = {{"waist_girth", 0.7, 0.745, 0.9, false, 0.0, {0.705, 0.745}},
                  {"hip_girth", 0.95, 1.0, 1.0, true, -0.012, {0.96, 1.0}}};
    fit.lengths = {{"knee_height", 0.48, 0.50, "the hem ends 2 cm above the knee"}};
    fit.regions = {{FitRegion::waist, "waist_girth", EaseClass::fitted, EaseSource::garment, 0.045,
                    0.045, Verdict::as_intended, "Sits as designed", 0.01, 0.03, 120.4, 300.0}};
    fit.contact = {4, 1, 2, 1};
    fit.strain = {0.03, 0.1, 0.5};
    fit.gap_m = {0.01f, -0.003f, 0.0f, 0.02345f};
    fit.warp = {0.0f, 0.1f, -0.05f, 1e-7f};
    fit.weft = {0.0f, 0.0f, -1e-9f, 0.0f};
    fit.pressure_pa = {0.0f, 1234.4f, 0.0f, 0.0f};
    FitReport report;
    report.body = "woman";
    report.garments = {fit};
    report.failures = {{FitFailureCode::deep_contact, "skirt", "1 of 4"},
                       {FitFailureCode::plugin_failed, "", "a plugin"}};
    return report;
}

TEST(FitFile, HoldsWhatWasMeasuredAndFitsTheSchema) {
    const json j = json::parse(fit_text(small_report()));
    EXPECT_THAT(test::JsonSchema("fit.schema.json").faults(j), IsEmpty());
    EXPECT_EQ(j["contact"]["deep_fraction"], 0.25);
    EXPECT_EQ(j["contact"]["self_intersections"], 0.5);
    EXPECT_EQ(j["strain"]["rms"], 0.03);
    const json& garment = j["garments"][0];
    EXPECT_EQ(garment["measurements"][0]["ease_m"], 0.045);
    EXPECT_EQ(garment["measurements"][0]["ease_by_size_m"]["S"], 0.005);
    EXPECT_EQ(garment["measurements"][1]["open"], true);
    EXPECT_EQ(garment["measurements"][1]["moved_m"], -0.012);
    EXPECT_EQ(garment["regions"][0]["verdict"], "as_intended");
    EXPECT_EQ(garment["between_sizes"], json::array({"M", "S"}));
    EXPECT_EQ(garment["vertices"]["ease_m"], json::array({0.01, -0.003, 0.0, 0.0235}));
    EXPECT_EQ(garment["vertices"]["pressure_pa"], json::array({0, 1234, 0, 0}));
    EXPECT_EQ(j["failures"][0]["code"], "deep_contact");
    EXPECT_FALSE(j["failures"][1].contains("garment"));
}

TEST(FitFile, ListsStandInOneLineEachAndNoNumberIsMinusZero) {
    const std::string text = fit_text(small_report());
    EXPECT_THAT(text, HasSubstr("\"strain_weft\": [0.0,0.0,0.0,0.0]"));
    EXPECT_EQ(text.find("-0.0,"), std::string::npos);
    EXPECT_EQ(text.find("@list"), std::string::npos);
    EXPECT_EQ(text, fit_text(small_report()));
}

TEST(FitFile, SeveralGarmentsCountTogether) {
    FitReport report = small_report();
    report.garments.push_back(report.garments[0]);
    report.garments[1].contact = {12, 0, 6, 0};
    report.garments[1].strain = {0.0, 0.2, 1.5};
    const json j = json::parse(fit_text(report));
    EXPECT_NEAR(j["contact"]["deep_fraction"].get<double>(), 1.0 / 16.0, 1e-6);
    EXPECT_EQ(j["contact"]["self_intersections"], 0.125);
    EXPECT_EQ(j["strain"]["rms"], 0.015); // sqrt(0.5 * 0.03^2 / 2)
    EXPECT_EQ(j["strain"]["max"], 0.2);
}

TEST(FitFile, TheSchemaRefusesWhatItShould) {
    const test::JsonSchema schema("fit.schema.json");
    const json sound = json::parse(fit_text(small_report()));
    json j = sound;
    j["garments"][0]["regions"][0]["verdict"] = "splendid";
    EXPECT_EQ(schema.faults(j).size(), 1u);
    j = sound;
    j["garments"][0].erase("vertices");
    EXPECT_EQ(schema.faults(j).size(), 1u);
    j = sound;
    j["contact"]["deep_fraction"] = 2;
    j["surprise"] = 1;
    EXPECT_EQ(schema.faults(j).size(), 2u);
}

TEST(FitFile, WhereNothingCanBeWrittenItSaysSo) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(write_fit(small_report(), folder / "no/such/fit.json"), Error);
    write_fit(small_report(), folder / "fit.json");
    std::ifstream in(folder / "fit.json");
    EXPECT_EQ(json::parse(in)["schema"], 1);
}

TEST(GarmentSchema, HoldsForTheGarmentsThatAreShipped) {
    const test::JsonSchema schema("garment.schema.json");
    for (const std::string& id : list_garments()) {
        std::ifstream in(find_garment(id) / "garment.json");
        json j = json::parse(in);
        EXPECT_THAT(schema.faults(j), IsEmpty()) << id;
        for (const json& said : {json("loose"), json{{"hip", "very_loose"}, {"waist", "fitted"}}}) {
            j["ease_class"] = said;
            EXPECT_THAT(schema.faults(j), IsEmpty()) << id;
        }
        for (const json& said : {json("snug"), json{{"nose", "loose"}}, json::object(), json(3)}) {
            j["ease_class"] = said;
            EXPECT_EQ(schema.faults(j).size(), 1u) << said;
        }
    }
}

TEST(Manifest, EaseClassesSurviveARoundTrip) {
    std::ifstream in(find_garment("skirt") / "garment.json");
    json j = json::parse(in);
    for (const json& said :
         {json("semi_fitted"), json{{"hip", "very_loose"}, {"waist", "stretch"}}}) {
        j["ease_class"] = said;
        Faults faults;
        const Manifest m = read_manifest(j.dump(), "garment.json", faults);
        ASSERT_TRUE(faults.empty()) << faults.front().text;
        EXPECT_EQ(json::parse(write_manifest(m))["ease_class"], said);
    }
}

} // namespace
} // namespace toile::garment
