#include "garment/package.h"

#include "assets/files.h"
#include "core/bytes.h"
#include "core/json.h"
#include "support/garments.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>

namespace toile::garment {
namespace {

std::string texts(const Faults& faults) {
    std::string out;
    for (const Fault& fault : faults)
        out += std::string(fault_name(fault.code)) + ": " + fault.text + "\n";
    return out;
}

TEST(Package, SurvivesARoundTrip) {
    const test::TemporaryFolder folder;
    const GarmentPackage made = test::small_package();
    write_package(made, folder.path());
    EXPECT_EQ(texts(check_package(folder.path())), "");
    const auto read = load_package(folder.path());
    EXPECT_EQ(write_manifest(read->manifest), write_manifest(made.manifest));
    ASSERT_EQ(read->sizes.size(), made.sizes.size());
    for (std::size_t i = 0; i < made.sizes.size(); ++i) {
        EXPECT_EQ(read->sizes[i].simulation.positions, made.sizes[i].simulation.positions);
        EXPECT_EQ(read->sizes[i].simulation.triangles, made.sizes[i].simulation.triangles);
        EXPECT_EQ(read->sizes[i].material_coords, made.sizes[i].material_coords);
        ASSERT_EQ(read->sizes[i].render.meshes.size(), 1u);
        const auto& a = read->sizes[i].render.meshes[0].primitives[0];
        const auto& b = made.sizes[i].render.meshes[0].primitives[0];
        EXPECT_EQ(a.positions, b.positions);
        EXPECT_EQ(a.texcoords, b.texcoords);
        EXPECT_EQ(a.triangles, b.triangles);
        EXPECT_EQ(a.variant_materials, b.variant_materials);
        EXPECT_EQ(read->sizes[i].render.variants, made.sizes[i].render.variants);
    }
    ASSERT_EQ(read->pins.size(), made.sizes[0].simulation.positions.size());
    EXPECT_EQ(read->pins[8 * 24], 1.0f);
    EXPECT_EQ(read->pins[0], 0.0f);
    EXPECT_EQ(read->size("M").entry.name, "M");
    EXPECT_ERROR(static_cast<void>(read->size("XL")), "its sizes: S, M");
}

TEST(Package, WritesEqualBytes) {
    const test::TemporaryFolder a;
    const test::TemporaryFolder b;
    write_package(test::small_package(), a.path());
    write_package(*load_package(a.path()), b.path());
    for (const char* const name : {"garment.json", "S.glb", "M.glb"})
        EXPECT_EQ(read_bytes(a / name, 1u << 20), read_bytes(b / name, 1u << 20)) << name;
}

TEST(Package, KeepsASkin) {
    GarmentPackage made = test::small_package();
    for (GarmentSize& size : made.sizes) {
        const std::size_t nv = size.simulation.positions.size();
        const auto left = static_cast<std::uint16_t>(body::Joint::left_upper_leg);
        size.skin.joints.assign(nv, {0, left, 0, 0});
        size.skin.weights.assign(nv, {0.75f, 0.25f, 0.0f, 0.0f});
    }
    const test::TemporaryFolder folder;
    write_package(made, folder.path());
    const auto read = load_package(folder.path());
    EXPECT_EQ(read->sizes[1].skin.joints, made.sizes[1].skin.joints);
    EXPECT_EQ(read->sizes[1].skin.weights, made.sizes[1].skin.weights);
    EXPECT_EQ(read->sizes[1].simulation.positions, made.sizes[1].simulation.positions);
}

TEST(Package, DrawsTheSimulationMeshWhenThereIsNoOther) {
    GarmentPackage made = test::small_package();
    made.manifest.variants.clear();
    for (GarmentSize& size : made.sizes)
        size.render = {};
    const test::TemporaryFolder folder;
    write_package(made, folder.path());
    const auto read = load_package(folder.path());
    ASSERT_EQ(read->sizes[0].render.meshes.size(), 1u);
    const auto& drawn = read->sizes[0].render.meshes[0].primitives[0];
    EXPECT_EQ(drawn.triangles.size(), made.sizes[0].simulation.triangles.size());
    EXPECT_EQ(drawn.texcoords.size(), drawn.positions.size());
    const test::TemporaryFolder again;
    write_package(*read, again.path());
    EXPECT_EQ(read_bytes(folder / "S.glb", 1u << 20), read_bytes(again / "S.glb", 1u << 20));
}

TEST(Package, ReadsObjMeshesWithARenderFile) {
    const test::TemporaryFolder folder;
    const GarmentPackage made = test::small_package();
    const GarmentSize& size = made.sizes[0];
    std::string text = "o simulation\n";
    for (const Vec3f& p : size.simulation.positions)
        text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
                std::to_string(p.z()) + "\n";
    for (const Vec2f& m : size.material_coords)
        text += "vt " + std::to_string(m.x()) + " " + std::to_string(m.y()) + "\n";
    for (std::size_t i = 0; i < size.simulation.triangles.size(); ++i) {
        text += "f";
        for (std::size_t k = 0; k < 3; ++k)
            text += " " + std::to_string(size.simulation.triangles[i][k] + 1) + "/" +
                    std::to_string(3 * i + k + 1);
        text += "\n";
    }
    write_text(folder / "S.obj", text);
    assets::save_scene(size.render, folder / "S-drawn.glb");
    Manifest manifest = made.manifest;
    manifest.sizes.resize(1);
    manifest.sizes[0].mesh = "S.obj";
    manifest.sizes[0].render = "S-drawn.glb";
    write_text(folder / "garment.json", write_manifest(manifest));
    EXPECT_EQ(texts(check_package(folder.path())), "");
    const auto read = load_package(folder.path());
    EXPECT_EQ(read->sizes[0].simulation.positions.size(), size.simulation.positions.size());
    EXPECT_EQ(read->sizes[0].simulation.triangles, size.simulation.triangles);
}

TEST(Manifest, IsWrittenAsItIsDocumented) {
    const std::string text = write_manifest(test::small_package().manifest);
    const auto json = parse_json(text, "garment.json");
    EXPECT_EQ(json.at("fabric").at("weight"), 180.0);
    EXPECT_EQ(json.at("fabric").at("thickness"), 0.5);
    EXPECT_EQ(json.at("pins").at(0).at("vertices").size(), 24u);
    EXPECT_EQ(json.at("variants").at(1).at("base_color"), "#7c7caa");
    EXPECT_EQ(json.at("body_mask").at(1), "left_upper_leg");
    EXPECT_EQ(json.at("sizes").at(0).at("chart").at("waist_girth").at("min"), 0.6);
}

TEST(Manifest, ReportsEveryFaultNotOnlyTheFirst) {
    Faults faults;
    std::string text = write_manifest(test::small_package().manifest);
    const auto replace = [&text](const std::string& from, const std::string& to) {
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
    };
    replace("\"weight\": 180.0", "\"weight\": 0.18");
    replace("\"id\": \"test-skirt\"", "\"id\": \"../Skirt\"");
    replace("\"mesh\": \"S.glb\"", "\"mesh\": \"/etc/S.glb\"");
    replace("\"layer\": 1", "\"layer\": 1, \"colour\": \"red\"");
    static_cast<void>(read_manifest(text, "garment.json", faults));
    ASSERT_EQ(faults.size(), 4u) << texts(faults);
    EXPECT_EQ(faults[0].code, FaultCode::value);
    EXPECT_EQ(faults[1].code, FaultCode::value);
    EXPECT_NE(faults[1].text.find("0.18 kg/m2 is written 180"), std::string::npos);
    EXPECT_EQ(faults[2].code, FaultCode::unsafe_path);
    EXPECT_EQ(faults[3].code, FaultCode::json);
}

} // namespace
} // namespace toile::garment
