// One broken 3D file per refusal, each made from a good one by changing its JSON.
#include "assets/files.h"
#include "assets/skins.h"
#include "core/bytes.h"
#include "core/json.h"
#include "support/scenes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cstring>
#include <functional>
#include <gtest/gtest.h>

namespace toile::assets {
namespace {

using nlohmann::json;

class GltfRefusals : public testing::Test {
  protected:
    // A .gltf and its .bin, changed before they are written.
    using Change = std::function<void(json&, std::vector<std::uint8_t>&)>;

    std::filesystem::path forged(const Change& change) {
        save_scene(test::everything(), folder_ / "good.glb");
        const std::vector<std::uint8_t> glb = read_bytes(folder_ / "good.glb", 1u << 24);
        std::uint32_t length = 0;
        std::memcpy(&length, glb.data() + 12, 4);
        json root = json::parse(glb.begin() + 20, glb.begin() + 20 + length);
        std::vector<std::uint8_t> bin(glb.begin() + 28 + length, glb.end());
        root["buffers"][0]["uri"] = "bad.bin";
        change(root, bin);
        write_text(folder_ / "bad.gltf", root.dump());
        write_bytes(folder_ / "bad.bin", bin);
        return folder_ / "bad.gltf";
    }
    void expect(const Change& change, const char* part) {
        EXPECT_ERROR((void)load_scene(forged(change)), part);
    }

    // Overwrites one number of an accessor.
    template <typename T>
    static void poke(const json& root, std::vector<std::uint8_t>& bin, const json& accessor,
                     std::size_t index, T value) {
        const json& view =
            root["bufferViews"]
                [root["accessors"][accessor.get<std::size_t>()]["bufferView"].get<std::size_t>()];
        std::memcpy(bin.data() + view["byteOffset"].get<std::size_t>() + index * sizeof(T), &value,
                    sizeof(T));
    }
    static json& primitive(json& root) { return root["meshes"][0]["primitives"][0]; }

    test::TemporaryFolder folder_;
};

TEST_F(GltfRefusals, TheUnchangedFileLoads) {
    EXPECT_NO_THROW((void)load_scene(forged([](json&, auto&) {})));
}

TEST_F(GltfRefusals, Claims) {
    expect([](json& r, auto&) { r["buffers"][0]["byteLength"] = 1u << 30; },
           "buffer 0 claims 1073741824 bytes");
    expect([](json& r, auto&) { r["accessors"][0]["count"] = 100000000; }, "more than 2000000");
    expect([](json& r, auto&) { r["accessors"][0]["count"] = 50000; }, "reach beyond its buffer");
    expect([](json& r, auto&) { r["bufferViews"][0]["byteOffset"] = 1u << 20; },
           "buffer view 0 reaches beyond its buffer");
    expect([](json& r, auto&) { r["bufferViews"][0]["buffer"] = 3; }, "names a missing buffer");
    expect([](json&, auto& bin) { bin.resize(bin.size() / 2); }, "bad.gltf: ");
}

TEST_F(GltfRefusals, Numbers) {
    expect(
        [](json& r, auto& bin) {
            poke(r, bin, primitive(r)["attributes"]["POSITION"], 7, std::nanf(""));
        },
        "POSITION holds a number that is not finite (element 2)");
    expect([](json& r, auto& bin) { poke(r, bin, primitive(r)["indices"], 5, 4000u); },
           "index 4000 is out of range");
    expect([](json& r, auto&) { r["nodes"][1]["translation"] = {1e300, 0, 0}; }, "not finite");
    expect([](json& r,
              auto& bin) { poke(r, bin, r["animations"][0]["samplers"][0]["input"], 1, 0.0f); },
           "times do not rise");
}

TEST_F(GltfRefusals, Skins) {
    expect(
        [](json& r, auto& bin) {
            for (std::size_t k = 0; k < 4; ++k)
                poke(r, bin, primitive(r)["attributes"]["WEIGHTS_0"], 4 * 30 + k, 0.0f);
        },
        "mesh 'tube', vertex 30: all weights are zero");
    expect([](json& r,
              auto& bin) { poke(r, bin, primitive(r)["attributes"]["WEIGHTS_0"], 4 * 30, 0.3f); },
           "vertex 30: weights sum to ");
    expect([](json& r,
              auto& bin) { poke(r, bin, primitive(r)["attributes"]["WEIGHTS_0"], 4 * 30, -0.5f); },
           "a weight is negative");
    expect(
        [](json& r, auto& bin) {
            poke(r, bin, primitive(r)["attributes"]["JOINTS_0"], 4 * 30, std::uint16_t{9});
        },
        "vertex 30: names joint 9 of 3");
    expect([](json& r, auto&) { r["skins"][0]["joints"][1] = 99; }, "joint node 99");
    expect([](json& r, auto&) { r["skins"][0]["joints"][1] = 1; }, "names the joint 'hips' twice");
    expect(
        [](json& r, auto& bin) {
            for (std::size_t k = 0; k < 3; ++k)
                poke(r, bin, r["skins"][0]["inverseBindMatrices"], k, 0.0f);
        },
        "cannot be inverted");
    expect(
        [](json& r, auto&) {
            r["skins"][0]["joints"] = json::array({1, 2, 3, 0});
        },
        "4 joints but 3 inverse bind matrices");
}

TEST_F(GltfRefusals, JointCycles) {
    expect([](json& r, auto&) { r["nodes"][3]["children"] = {1}; }, "node 'hips' has two parents");
    expect(
        [](json& r, auto&) {
            r["nodes"][0]["children"] = json::array({});
            r["nodes"][3]["children"] = {1};
        },
        "node 'hips' is part of a cycle");
    expect([](json& r, auto&) { r["nodes"][2]["children"] = {77}; }, "does not exist");
}

TEST_F(GltfRefusals, FilesOutsideItsFolder) {
    expect([](json& r, auto&) { r["buffers"][0]["uri"] = "../bad.bin"; }, "outside its folder");
    expect([](json& r, auto&) { r["buffers"][0]["uri"] = "%2e%2e/bad.bin"; }, "outside its folder");
    expect([](json& r, auto&) { r["buffers"][0]["uri"] = "gone.bin"; }, "bad.gltf: ");
    expect(
        [](json& r, auto&) {
            r["images"][0] = {{"uri", "../secret.png"}};
        },
        "outside its folder");
    expect(
        [](json& r, auto&) {
            r["images"][0] = {{"uri", "gone.png"}};
        },
        "the texture 'gone.png' is missing");
}

TEST_F(GltfRefusals, TheRest) {
    expect([](json& r, auto&) { r["asset"]["version"] = "1.0"; }, "not glTF 2");
    expect([](json& r, auto&) { r["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
           "KHR_draco_mesh_compression");
    expect([](json& r, auto&) { r["nodes"] = 5; }, "'nodes' must be an array");
    expect([](json& r, auto&) { r["nodes"][4]["mesh"] = 8; }, "names a mesh that does not exist");
    expect([](json& r, auto&) { primitive(r)["material"] = 8; }, "material that does not exist");
    expect([](json& r, auto&) { primitive(r)["attributes"].erase("POSITION"); }, "no POSITION");
    expect([](json& r, auto&) { primitive(r)["attributes"].erase("WEIGHTS_0"); },
           "JOINTS_0 without WEIGHTS_0");
    write_text(folder_ / "a.gltf", "{\"asset\":");
    EXPECT_ERROR((void)load_scene(folder_ / "a.gltf"), "not valid JSON");
    write_text(folder_ / "a.glb", "glTF");
    EXPECT_ERROR((void)load_scene(folder_ / "a.glb"), "not a GLB file");
}

TEST(Skins, MoreThanFourInfluencesKeepTheLargest) {
    std::vector<Influence> row = {{5, 0.1f}, {1, 0.3f},  {2, 0.05f},
                                  {3, 0.3f}, {4, 0.15f}, {0, 0.1f}};
    std::array<std::uint16_t, 4> joints{};
    std::array<float, 4> weights{};
    keep_four(row, joints, weights);
    EXPECT_EQ(joints, (std::array<std::uint16_t, 4>{1, 3, 4, 0})); // of equals the lower joint
    EXPECT_NEAR(weights[0], 0.3 / 0.85, 1e-6);
    EXPECT_NEAR(weights[0] + weights[1] + weights[2] + weights[3], 1.0f, 1e-6f);
}

TEST(Skins, SumsWithinTheToleranceAreScaled) {
    Scene scene = test::everything();
    scene.meshes[0].primitives[0].weights[40] = {0.6f, 0.41f, 0, 0};
    check_skins(scene, "x");
    EXPECT_NEAR(scene.meshes[0].primitives[0].weights[40][0], 0.6 / 1.01, 1e-6);
    scene.meshes[0].primitives[0].weights[40] = {0.6f, 0.5f, 0, 0};
    EXPECT_ERROR(check_skins(scene, "x"), "weights sum to 1.1");
}

TEST(Skins, OurOwnSceneStandsAsBound) {
    const Scene scene = test::everything();
    const Primitive& p = scene.meshes[0].primitives[0];
    const auto posed = skinned_positions(p, scene.skins[0], node_transforms(scene));
    for (std::size_t v = 0; v < posed.size(); ++v)
        EXPECT_LT((posed[v] - p.positions[v]).norm(), 1e-6f);
}

TEST(Obj, RefusalsNameTheLine) {
    const test::TemporaryFolder folder;
    const auto load = [&](const std::string& text) {
        write_text(folder / "a.obj", text);
        return load_scene(folder / "a.obj");
    };
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_ERROR((void)load(corners + "f 1 2 4\n"), "line 4: index 4 is out of range");
    EXPECT_ERROR((void)load(corners + "f 1 2 -4\n"), "line 4: index -4 is out of range");
    EXPECT_ERROR((void)load(corners + "f 1 2\n"), "line 4: a face needs");
    EXPECT_ERROR((void)load("v 0 nan 0\n"), "line 1: 'nan' is not a finite number");
    EXPECT_ERROR((void)load(corners), "holds no faces");
    EXPECT_ERROR((void)load("mtllib ../x.mtl\n" + corners + "f 1 2 3\n"), "outside its folder");
    write_text(folder / "x.mtl", "newmtl m\nmap_Kd gone.png\n");
    EXPECT_ERROR((void)load("mtllib x.mtl\n" + corners + "f 1 2 3\n"), "'gone.png' is missing");
    const Scene quad = load(corners + "v 1 1 0\ng patch\nf 1 2 4 3\n");
    EXPECT_EQ(quad.meshes[0].name, "patch");
    EXPECT_EQ(quad.meshes[0].primitives[0].triangles.size(), 2u);
}

TEST(Ply, RefusalsSayWhy) {
    const test::TemporaryFolder folder;
    const auto load = [&](const std::string& text) {
        write_text(folder / "a.ply", text);
        return load_scene(folder / "a.ply");
    };
    const auto file = [](const std::string& vertices, const std::string& body) {
        return "ply\nformat ascii 1.0\nelement vertex " + vertices +
               "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n" +
               body;
    };
    EXPECT_NO_THROW((void)load(file("3", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")));
    EXPECT_ERROR((void)load(file("1000000000", "0 0 0\n")), "claims 1000000000 of 'vertex'");
    EXPECT_ERROR((void)load(file("3", "0 0 0\n1 0 0\n0 1 0\n3 0 1 5\n")), "index out of range");
    EXPECT_ERROR((void)load(file("3", "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n")),
                 "vertex 1 is not finite");
    EXPECT_ERROR((void)load(file("3", "0 0 0\n1 0 0\n")), "ends too early");
    EXPECT_ERROR((void)load("plywood\n"), "not a PLY file");
}

} // namespace
} // namespace toile::assets
