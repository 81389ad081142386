// toile dress as a user calls it: both fits, the garment as a package, and what is refused.
#include "assets/colored_mesh.h"
#include "assets/files.h"
#include "body/body_model.h"
#include "geometry/cut.h"
#include "support/meshes.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace toile::test {
namespace {

using testing::HasSubstr;

constexpr assets::Rgba8 kSkin = {205, 170, 150, 255}, kPaint = {190, 190, 195, 255},
                        kCloth = {40, 70, 160, 255};

assets::ColoredMesh bare(const std::string& avatar, const assets::Rgba8& color) {
    const auto model = body::load_body_model(body::find_avatar(avatar));
    return {model.rest, std::vector<assets::Rgba8>(model.rest.positions.size(), color)};
}

/// A painted mannequin in a tunic: 15 mm off trunk and thighs, blue.
assets::ColoredMesh dressed_mannequin() {
    const auto model = body::load_body_model(body::find_avatar("women-m"));
    assets::ColoredMesh out = bare("women-m", kPaint);
    for (std::size_t v = 0; v < model.parts.size(); ++v) {
        const Vec3f& p = model.rest.positions[v];
        const bool cloth =
            (model.parts[v] == body::Part::torso || model.parts[v] == body::Part::pelvis) &&
            p.y() < 1.33f;
        if (!cloth) continue;
        out.colors[v] = kCloth;
        out.mesh.positions[v] += 0.015f * model.rest.normals[v];
    }
    out.mesh.normals.clear();
    return out;
}

/// Both scans in a folder of their own, made once.
struct Scans {
    TemporaryFolder folder;
    std::filesystem::path mannequin = folder / "mannequin.ply", customer = folder / "customer.ply";

    Scans() {
        assets::save_scene(assets::scene_of(dressed_mannequin(), "scan"), mannequin);
        assets::save_scene(assets::scene_of(bare("women-l", kSkin), "scan"), customer);
    }
};
Scans& scans() {
    static Scans all;
    return all;
}

ProgramResult dress(const std::filesystem::path& mannequin, const std::filesystem::path& customer,
                    const std::filesystem::path& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"dress",      "--mannequin",     mannequin.string(),
                                      "--customer", customer.string(), "--out",
                                      out.string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_toile(words);
}

nlohmann::json read_json(const std::filesystem::path& file) {
    return nlohmann::json::parse(std::ifstream(file));
}

TEST(Dress, TheWholeCustomerInTheMannequinsTunic) {
    const TemporaryFolder folder;
    const ProgramResult result =
        dress(scans().mannequin, scans().customer, folder / "look.glb",
              {"--fit", "body", "--report", (folder / "report.json").string(), "--garment-out",
               (folder / "tunic").string(), "--picture", (folder / "look.png").string()});
    ASSERT_EQ(result.status, 0) << result.output;
    const auto report = read_json(folder / "report.json");
    EXPECT_EQ(report.at("fit"), "body");
    EXPECT_TRUE(report.at("garment").at("by_color").get<bool>());
    EXPECT_LT(report.at("garment").at("room_change_m").at("p95").get<double>(), 0.01);
    EXPECT_TRUE(std::filesystem::exists(folder / "look.png"));
    // Closed, with the colours of cloth and of the customer's skin.
    const auto look = assets::load_colored_mesh(folder / "look.glb");
    EXPECT_TRUE(geometry::rims(look.mesh).empty());
    std::size_t cloth = 0, paint = 0;
    for (const auto& c : look.colors) {
        cloth += c[2] > c[0] + 60 ? 1 : 0;
        paint += c[2] > c[0] ? 1 : 0;
    }
    EXPECT_GT(cloth, look.colors.size() / 6);
    EXPECT_LT(paint - cloth, look.colors.size() / 20) << "the mannequin's paint is left";
    // The garment by itself is a sound package, and can be worn.
    const ProgramResult check = run_toile({"garment", "check", (folder / "tunic").string()});
    EXPECT_EQ(check.status, 0) << check.output;
    const ProgramResult worn =
        run_toile({"tryon", "--body", "woman", "--garment", (folder / "tunic").string(), "--out",
                   (folder / "worn.png").string(), "--quality", "fast"});
    EXPECT_EQ(worn.status, 0) << worn.output;
}

TEST(Dress, TheAbdomenOnlyLeavesHeightAndLimbs) {
    const TemporaryFolder folder;
    for (const char* strips : {"3", "40"}) {
        const ProgramResult result =
            dress(scans().mannequin, scans().customer, folder / "look.ply", {"--strips", strips});
        ASSERT_EQ(result.status, 0) << result.output;
        const auto look = assets::load_colored_mesh(folder / "look.ply");
        EXPECT_TRUE(geometry::rims(look.mesh).empty()) << strips;
        float low = 1e9f;
        for (const Vec3f& p : look.mesh.positions)
            low = std::min(low, p.y());
        EXPECT_NEAR(low, 0.0f, 0.01f);
    }
}

TEST(Dress, ACustomerWhoStandsElsewhereIsTheSame) {
    const TemporaryFolder folder;
    auto away = bare("women-l", kSkin);
    for (Vec3f& p : away.mesh.positions)
        p += Vec3f(6.0f, 0.0f, -4.0f);
    away.mesh.normals.clear();
    assets::save_scene(assets::scene_of(away, "scan"), folder / "away.ply");
    const ProgramResult result =
        dress(scans().mannequin, folder / "away.ply", folder / "look.glb", {"--fit", "body"});
    ASSERT_EQ(result.status, 0) << result.output;
    const auto look = assets::load_colored_mesh(folder / "look.glb");
    EXPECT_TRUE(geometry::rims(look.mesh).empty());
    for (const Vec3f& p : look.mesh.positions)
        EXPECT_LT((p - Vec3f(6.0f, 0.9f, -4.0f)).norm(), 1.5f);
}

TEST(Dress, BadScansAreRefusedByName) {
    const TemporaryFolder folder;
    const auto fails = [&](const std::filesystem::path& mannequin,
                           const std::filesystem::path& customer, const std::string& text) {
        const ProgramResult result = dress(mannequin, customer, folder / "look.glb");
        EXPECT_EQ(result.status, 1) << result.output;
        EXPECT_THAT(result.output, HasSubstr(text));
        EXPECT_FALSE(std::filesystem::exists(folder / "look.glb"));
    };
    fails(folder / "none.ply", scans().customer, "none.ply");
    std::ofstream(folder / "empty.ply")
        << "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
           "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
    fails(scans().mannequin, folder / "empty.ply", "empty.ply");
    auto lying = bare("women-l", kSkin);
    for (Vec3f& p : lying.mesh.positions)
        p = Vec3f(p.x(), -p.z(), p.y());
    lying.mesh.normals.clear();
    assets::save_scene(assets::scene_of(lying, "scan"), folder / "lying.ply");
    fails(scans().mannequin, folder / "lying.ply", "the customer's scan: ");
    fails(folder / "lying.ply", scans().customer, "upright");
    assets::save_scene(assets::scene_of({sphere(0.9f, 4), {}}, "scan"), folder / "ball.ply");
    fails(scans().mannequin, folder / "ball.ply", "does not look like");
}

TEST(Dress, WrongUseIsToldBeforeTheWork) {
    const TemporaryFolder folder;
    EXPECT_EQ(dress(scans().mannequin, scans().customer, folder / "look.fbx").status, 2);
    EXPECT_EQ(
        dress(scans().mannequin, scans().customer, folder / "look.glb", {"--fit", "arms"}).status,
        2);
    EXPECT_EQ(
        dress(scans().mannequin, scans().customer, folder / "look.glb", {"--strips", "0"}).status,
        2);
    EXPECT_EQ(run_toile({"dress", "--out", "x.glb"}).status, 2);
}

} // namespace
} // namespace toile::test
