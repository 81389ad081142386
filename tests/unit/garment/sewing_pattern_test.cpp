// Sewing patterns from outside: pieces, recipes, DXF and GarmentCode files.
#include "core/bytes.h"
#include "garment/dxf_reader.h"
#include "garment/pattern_piece.h"
#include "garment/placed_pattern.h"
#include "garment/recipe.h"
#include "support/json_schema.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <numbers>

namespace toile::garment::block {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

PatternPiece square() {
    PatternPiece piece;
    piece.name = "square";
    piece.outline = {{0.0, 0.0}, {0.2, 0.0}, {0.2, 0.2}, {0.0, 0.2}};
    return piece;
}

TEST(PatternPiece, IsMadeCounterClockwiseAndFreeOfDoublePoints) {
    PatternPiece piece = square();
    std::reverse(piece.outline.begin(), piece.outline.end());
    piece.outline.push_back(piece.outline.front());
    check_piece(piece);
    EXPECT_EQ(piece.outline.size(), 4u);
    EXPECT_NEAR(signed_area(piece.outline), 0.04, 1e-12);
}

TEST(PatternPiece, RefusesWhatCannotBeCut) {
    PatternPiece bow = square();
    bow.outline = {{0.0, 0.0}, {0.2, 0.2}, {0.2, 0.0}, {0.0, 0.3}};
    EXPECT_ERROR(check_piece(bow), "piece 'square': its outline crosses itself near");
    PatternPiece flat = square();
    flat.outline = {{0.0, 0.0}, {0.1, 0.0}, {0.2, 0.0}};
    EXPECT_ERROR(check_piece(flat), "has no area");
    PatternPiece lost = square();
    lost.outline[2].x() = std::nan("");
    EXPECT_ERROR(check_piece(lost), "not finite");
}

TEST(OutlineWalk, CutsPiecesOutOfAnOutline) {
    const PatternPiece piece = square();
    const OutlineWalk walk(piece.outline);
    double off = 0.0;
    EXPECT_NEAR(walk.project({0.1, -0.01}, off), 0.1, 1e-12);
    EXPECT_NEAR(off, 0.01, 1e-12);
    EXPECT_NEAR(length(walk.between(0.1, 0.5)), 0.4, 1e-12);
    // Over the first point.
    const auto around = walk.between(0.7, 0.1);
    EXPECT_NEAR(length(around), 0.2, 1e-12);
    EXPECT_NEAR((around[1] - Vec2d(0.0, 0.0)).norm(), 0.0, 1e-12);
}

TEST(DraftedPieces, AreTurnedUprightAndIntoMetres) {
    const auto pieces = read_drafted_pieces(
        R"({"pieces": [{"name": "front", "outline": [[0, 0], [100, 0], [100, 300], [0, 300]],
            "points": {"hem": [100, 300]}}]})",
        "a test");
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_NEAR((pieces[0].points.at("hem") - Vec2d(0.1, -0.3)).norm(), 0.0, 1e-12);
    EXPECT_GT(signed_area(pieces[0].outline), 0.0);
    EXPECT_ERROR((void)read_drafted_pieces(R"({"pieces": [{"name": "a", "outline": [[0]],
                                               "points": {}}]})",
                                           "a test"),
                 "a test: piece 'a', outline: is not a pair of numbers");
}

// A recipe that is whole; `change` breaks it.
Recipe load(const std::function<void(json&)>& change) {
    json recipe = json::parse(R"({
        "schema": 1, "id": "tube", "name": "Tube", "kind": "skirt", "layer": 1, "dxf": "tube.dxf",
        "sizes_on": "women", "fabric": "jersey",
        "panels": [{"name": "front", "piece": "a", "border": [["p0", "hem"], ["p1", "side"]],
                    "wrap": {"on": "torso_front", "levels": {"p0": "waist"}, "inner": ["hem"],
                             "outer": ["side"]}}],
        "seams": [["front.hem", "-front.side"]], "centres": [],
        "parts": [{"name": "cloth", "panels": [""], "weave": "jersey"}],
        "colourways": [{"name": "red", "color": "#ff0000"}], "chart": ["waist_girth"]})");
    change(recipe);
    const test::TemporaryFolder folder;
    write_text(folder / "tube.json", recipe.dump());
    return load_recipe(folder / "tube.json");
}

TEST(Recipe, ReadsSeamsAsRows) {
    const Recipe recipe = load([](json& r) {
        r["seams"] = json::parse(R"([["back.armhole+-yoke.armhole", "sleeve.cap"]])");
    });
    ASSERT_EQ(recipe.seams.size(), 1u);
    ASSERT_EQ(recipe.seams[0].a.size(), 2u);
    EXPECT_TRUE(recipe.seams[0].a[1].reversed);
    EXPECT_EQ(recipe.seams[0].a[1].panel, "yoke");
    EXPECT_EQ(recipe.seams[0].b[0].edge, "cap");
    EXPECT_EQ(recipe.pieces_file.filename(), "tube.dxf");
}

TEST(Recipe, NamesWhatIsWrong) {
    EXPECT_ERROR((void)load([](json& r) { r["sleves"] = 1; }), "sleves");
    EXPECT_ERROR((void)load([](json& r) { r["panels"][0]["wrap"]["on"] = "tail"; }),
                 "'tail' is none of torso_front");
    EXPECT_ERROR((void)load([](json& r) { r["seams"][0] = {"front.hem"}; }), "[edges, edges]");
    EXPECT_ERROR((void)load([](json& r) {
                     r["seams"][0] = {"front", "front.side"};
                 }),
                 "'front' is not of the form panel.edge");
    EXPECT_ERROR((void)load([](json& r) { r["colourways"][0]["color"] = "red"; }), "#rrggbb");
    EXPECT_ERROR((void)load([](json& r) { r["parts"][0]["weave"] = "felt"; }),
                 "'felt' is none of jersey");
    EXPECT_ERROR(
        (void)load([](json& r) { r["panels"][0]["border"] = json::parse(R"([["p0", "hem"]])"); }),
        "at least two corners");
}

TEST(Recipe, AllThatComeAlongAreReadAndFitTheirSchema) {
    const test::JsonSchema schema("recipe.schema.json");
    std::size_t count = 0;
    for (const auto& entry :
         fs::directory_iterator(fs::path(TOILE_SOURCE_DIR) / "garments/recipes")) {
        SCOPED_TRACE(entry.path().filename());
        EXPECT_EQ(load_recipe(entry.path()).id, entry.path().stem());
        std::ifstream in(entry.path());
        EXPECT_THAT(schema.faults(test::JsonSchema::Json::parse(in)), testing::IsEmpty());
        ++count;
    }
    EXPECT_GE(count, 12u);
}

// A DXF in the manner of pattern CAD: one block, polyline on the cut and the sew layer.
std::string dxf(const std::string& unit, const std::string& sew, const std::string& grain) {
    const auto polyline = [](const std::string& layer, const std::string& points) {
        return "0\nPOLYLINE\n8\n" + layer + "\n66\n1\n70\n1\n" + points + "0\nSEQEND\n8\n" + layer +
               "\n";
    };
    return "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n1\n2\nB1\n0\nTEXT\n8\n1\n1\nPiece Name: BACK\n" +
           polyline("1", sew) + polyline("14", sew) + "0\nPOINT\n8\n4\n10\n50\n20\n0\n" + grain +
           "0\nENDBLK\n0\nENDSEC\n0\nSECTION\n2\n"
           "ENTITIES\n0\nTEXT\n8\n1\n1\nUNITS: " +
           unit + "\n0\nENDSEC\n0\nEOF\n";
}

std::string vertices(const std::vector<Vec2d>& points) {
    std::string text;
    for (const Vec2d& p : points) {
        text += "0\nVERTEX\n8\n1\n10\n" + std::to_string(p.x()) + "\n20\n" + std::to_string(p.y()) +
                "\n";
    }
    return text;
}

std::vector<PatternPiece> read(const std::string& text) {
    const test::TemporaryFolder folder;
    write_text(folder / "a.dxf", text);
    return read_dxf(folder / "a.dxf");
}

TEST(Dxf, ReadsPiecesCornersNotchesAndGrain) {
    const std::string rectangle = vertices({{0, 0}, {100, 0}, {100, 400}, {0, 400}});
    const auto upright = read(dxf("METRIC", rectangle, ""));
    ASSERT_EQ(upright.size(), 1u);
    EXPECT_EQ(upright[0].name, "BACK");
    EXPECT_NEAR(signed_area(upright[0].outline), 0.04, 1e-9);
    EXPECT_EQ(upright[0].points.count("p3"), 1u);
    EXPECT_EQ(upright[0].points.count("p4"), 0u);
    EXPECT_NEAR((upright[0].points.at("n0") - Vec2d(0.05, 0.0)).norm(), 0.0, 1e-9);
    // Grain along x: the piece is turned so that it runs up.
    const auto turned =
        read(dxf("METRIC", rectangle, "0\nLINE\n8\n7\n10\n0\n20\n0\n11\n50\n21\n0\n"));
    Vec2d low = turned[0].outline[0];
    Vec2d high = low;
    for (const Vec2d& p : turned[0].outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    EXPECT_NEAR((high - low).x(), 0.4, 1e-9);
    EXPECT_NEAR((high - low).y(), 0.1, 1e-9);
    EXPECT_NEAR(
        signed_area(
            read(dxf("ENGLISH", vertices({{0, 0}, {10, 0}, {10, 10}, {0, 10}}), ""))[0].outline),
        0.254 * 0.254, 1e-9);
}

TEST(Dxf, RefusesWhatIsNoPattern) {
    EXPECT_ERROR((void)read("Hello\nworld\n"), "is no group code: this is no DXF");
    EXPECT_ERROR((void)read("0\nEOF\n"), "holds no piece");
    EXPECT_ERROR((void)read(dxf("METRIC", vertices({{0, 0}, {100, 100}, {100, 0}, {0, 150}}), "")),
                 "piece 'BACK': its outline crosses itself");
}

class GarmentCode : public testing::Test {
  protected:
    // Front and back of a tube, sewn at the sides.
    json pattern_ = json::parse(R"({"pattern": {"panels": {
        "front": {"translation": [-25, 60, 20], "rotation": [0, 0, 0],
                  "vertices": [[0, 0], [50, 0], [50, 40], [0, 40]],
                  "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
                            {"endpoints": [3, 0]}]},
        "back": {"translation": [-25, 60, -20], "rotation": [0, 0, 0],
                 "vertices": [[0, 0], [50, 0], [50, 40], [0, 40]],
                 "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
                           {"endpoints": [3, 0]}]}},
        "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 1}],
                     [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 3}]]},
        "properties": {"units_in_meter": 100}})");
    test::TemporaryFolder folder_;

    SpatialPattern read() {
        write_text(folder_ / "tube.json", pattern_.dump());
        return read_garmentcode(folder_ / "tube.json");
    }
    json& front() { return pattern_["pattern"]["panels"]["front"]; }
};

TEST_F(GarmentCode, ReadsPanelsCurvesAndStitches) {
    // A half circle outwards below the hem: 25 cm radius over a chord of 50 cm.
    front()["edges"][0]["curvature"] = {{"type", "circle"}, {"params", {25.0, 0, 1}}};
    const SpatialPattern pattern = read();
    ASSERT_EQ(pattern.panels.size(), 2u);
    EXPECT_EQ(pattern.stitches.size(), 2u);
    const auto& panel = pattern.panels[1]; // sorted by name
    EXPECT_NEAR(length(panel.border[0].points), 0.25 * std::numbers::pi, 1e-3);
    double lowest = 0.0;
    for (const Vec2d& p : panel.border[0].points) {
        lowest = std::min(lowest, p.y());
    }
    EXPECT_NEAR(lowest, -0.25, 1e-6);
    EXPECT_NEAR((panel.place * Vec3d(0.25, 0.0, 0.0) - Vec3d(0.0, 0.6, 0.2)).norm(), 0.0, 1e-12);
}

TEST_F(GarmentCode, NamesWhatIsWrong) {
    const json whole = pattern_;
    front()["vertices"] = json::parse("[[0, 0], [50, 40], [50, 0], [0, 45]]");
    EXPECT_ERROR((void)read(), "piece 'front': its outline crosses itself");
    pattern_ = whole;
    front()["vertices"] = json::parse("[[0, 0], [10, 0], [20, 0], [30, 0]]");
    EXPECT_ERROR((void)read(), "piece 'front': its outline has no area");
    pattern_ = whole;
    pattern_["pattern"]["stitches"][0][1]["panel"] = "sleeve";
    EXPECT_ERROR((void)read(), "stitch 0 names a panel that does not exist: 'sleeve'");
    pattern_ = whole;
    pattern_["pattern"]["stitches"][0][1]["edge"] = 9;
    EXPECT_ERROR((void)read(), "stitch 0 names nothing that exists");
    pattern_ = whole;
    pattern_["pattern"]["panels"]["back"]["vertices"] =
        json::parse("[[0, 0], [50, 0], [50, 10], [0, 10]]");
    EXPECT_ERROR((void)read(), "differ too much in length to be sewn together");
    pattern_ = whole;
    front()["edges"][2]["endpoints"] = {2, 1};
    EXPECT_ERROR((void)read(), "panel 'front', edge 3 does not start where");
    pattern_ = whole;
    front()["edges"][0]["curvature"] = {{"type", "spiral"}, {"params", {1}}};
    EXPECT_ERROR((void)read(), "is none of quadratic, cubic and circle");
    pattern_ = whole;
    front()["vertices"][0] = {"a", 0};
    EXPECT_ERROR((void)read(), "panel 'front', a vertex is not a number");
}

TEST(GarmentCodeData, AllPatternsAtHandAreRead) {
    TOILE_SHARED_DATA_OR_SKIP(folder, "garmentcode_patterns");
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder / "Patterns")) {
        EXPECT_TRUE(is_garmentcode(entry.path()));
        EXPECT_GT(read_garmentcode(entry.path()).stitches.size(), 10u);
        ++count;
    }
    EXPECT_EQ(count, 4u);
}

} // namespace
} // namespace toile::garment::block
