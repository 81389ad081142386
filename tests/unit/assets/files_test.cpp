#include "assets/files.h"

#include "assets/skins.h"
#include "core/bytes.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>
#include <gtest/gtest.h>

namespace toile::assets {
namespace {

void expect_equal(const Primitive& a, const Primitive& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.texcoords, b.texcoords);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.joints, b.joints);
    EXPECT_EQ(a.weights, b.weights);
    EXPECT_EQ(a.material, b.material);
    EXPECT_EQ(a.variant_materials, b.variant_materials);
    ASSERT_EQ(a.normals.size(), b.normals.size());
    ASSERT_EQ(a.morphs.size(), b.morphs.size());
    for (std::size_t m = 0; m < a.morphs.size(); ++m) {
        EXPECT_EQ(a.morphs[m].name, b.morphs[m].name);
        EXPECT_EQ(a.morphs[m].positions, b.morphs[m].positions);
    }
}

void expect_equal(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        EXPECT_EQ(a.nodes[i].name, b.nodes[i].name);
        EXPECT_EQ(a.nodes[i].parent, b.nodes[i].parent);
        EXPECT_EQ(a.nodes[i].mesh, b.nodes[i].mesh);
        EXPECT_EQ(a.nodes[i].skin, b.nodes[i].skin);
        EXPECT_EQ(a.nodes[i].translation, b.nodes[i].translation);
        EXPECT_TRUE(a.nodes[i].rotation.coeffs().isApprox(b.nodes[i].rotation.coeffs(), 1e-6f));
        EXPECT_EQ(a.nodes[i].scale, b.nodes[i].scale);
    }
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        EXPECT_EQ(a.meshes[i].name, b.meshes[i].name);
        EXPECT_EQ(a.meshes[i].morph_weights, b.meshes[i].morph_weights);
        ASSERT_EQ(a.meshes[i].primitives.size(), b.meshes[i].primitives.size());
        for (std::size_t p = 0; p < a.meshes[i].primitives.size(); ++p)
            expect_equal(a.meshes[i].primitives[p], b.meshes[i].primitives[p]);
    }
    ASSERT_EQ(a.skins.size(), b.skins.size());
    for (std::size_t i = 0; i < a.skins.size(); ++i) {
        EXPECT_EQ(a.skins[i].joints, b.skins[i].joints);
        for (std::size_t j = 0; j < a.skins[i].inverse_bind.size(); ++j)
            EXPECT_TRUE(a.skins[i].inverse_bind[j].isApprox(b.skins[i].inverse_bind[j], 1e-6f));
    }
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        EXPECT_EQ(a.materials[i].name, b.materials[i].name);
        EXPECT_EQ(a.materials[i].base_color, b.materials[i].base_color);
        EXPECT_EQ(a.materials[i].sheen_color, b.materials[i].sheen_color);
        EXPECT_EQ(a.materials[i].base_color_texture, b.materials[i].base_color_texture);
        EXPECT_EQ(a.materials[i].double_sided, b.materials[i].double_sided);
    }
    ASSERT_EQ(a.textures.size(), b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i)
        EXPECT_EQ(a.textures[i].image.pixels, b.textures[i].image.pixels);
    EXPECT_EQ(a.variants, b.variants);
    ASSERT_EQ(a.animations.size(), b.animations.size());
    for (std::size_t i = 0; i < a.animations.size(); ++i) {
        ASSERT_EQ(a.animations[i].channels.size(), b.animations[i].channels.size());
        for (std::size_t c = 0; c < a.animations[i].channels.size(); ++c) {
            EXPECT_EQ(a.animations[i].channels[c].node, b.animations[i].channels[c].node);
            EXPECT_EQ(a.animations[i].channels[c].times, b.animations[i].channels[c].times);
        }
    }
}

void expect_weights_sum_to_one(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives)
            for (const auto& w : p.weights)
                EXPECT_NEAR(double(w[0]) + double(w[1]) + double(w[2]) + double(w[3]), 1.0, 3e-7);
}

TEST(Glb, RoundTripKeepsEverything) {
    const test::TemporaryFolder folder;
    const Scene scene = test::everything();
    save_scene(scene, folder / "a.glb");
    const Scene back = load_scene(folder / "a.glb");
    expect_equal(scene, back);
    EXPECT_EQ(back.materials[0].sheen_roughness, 0.3f);
    save_scene(back, folder / "b.glb");
    EXPECT_TRUE(read_bytes(folder / "a.glb", 1u << 24) == read_bytes(folder / "b.glb", 1u << 24));
}

class SharedSkins : public testing::TestWithParam<const char*> {};

TEST_P(SharedSkins, LoadAndComeBackTheSame) {
    TOILE_SHARED_DATA_OR_SKIP(set, std::string(GetParam()).ends_with(".fbx") ? "fbx_skins"
                                                                             : "gltf_skins");
    const Scene scene = load_scene(set / GetParam());
    EXPECT_FALSE(scene.meshes.empty());
    expect_weights_sum_to_one(scene);

    // In the bind pose (world_from_joint = inverse of inverse_bind) every vertex stays in place.
    for (const Node& node : scene.nodes) {
        if (node.skin == kNone || node.mesh == kNone) continue;
        const Skin& skin = scene.skins[static_cast<std::size_t>(node.skin)];
        auto world = node_transforms(scene);
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            world[static_cast<std::size_t>(skin.joints[j])] = skin.inverse_bind[j].inverse();
        for (const Primitive& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            const std::vector<Vec3f> posed = skinned_positions(p, skin, world);
            float extent = 0.0f;
            float worst = 0.0f;
            for (std::size_t v = 0; v < posed.size(); ++v) {
                extent = std::max(extent, p.positions[v].norm());
                worst = std::max(worst, (posed[v] - p.positions[v]).norm());
            }
            EXPECT_LT(worst, 1e-5f * extent);
        }
    }

    const test::TemporaryFolder folder;
    save_scene(scene, folder / "a.glb");
    const Scene back = load_scene(folder / "a.glb");
    expect_equal(scene, back);
    save_scene(scene, folder / "b.glb");
    EXPECT_TRUE(read_bytes(folder / "a.glb", 1u << 26) == read_bytes(folder / "b.glb", 1u << 26));
}

INSTANTIATE_TEST_SUITE_P(All, SharedSkins,
                         testing::Values("CesiumMan_blender_reexport.glb", "RiggedSimple.glb",
                                         "RiggedSimple_blender_reexport.glb", "quad_skin.glb",
                                         "simple_skin.gltf",
                                         "AnimatedMorphCube/glTF/AnimatedMorphCube.gltf",
                                         "AnimatedMorphSphere/glTF/AnimatedMorphSphere.gltf",
                                         "MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf",
                                         "MorphStressTest/glTF/MorphStressTest.gltf",
                                         "SimpleMorph/glTF/SimpleMorph.gltf",
                                         "animation_with_skeleton.fbx", "huesitos.fbx"));

TEST(SharedSkins, OldExportsWithWrongWeightsAreRefused) {
    TOILE_SHARED_DATA_OR_SKIP(set, "gltf_skins");
    EXPECT_ERROR((void)load_scene(set / "CesiumMan.glb"),
                 "mesh 'Cesium_Man', vertex 0: weights sum to 0.68");
    EXPECT_ERROR((void)load_scene(set / "RiggedFigure.glb"), "weights sum to 0.89");
}

TEST(Obj, RoundTripKeepsOrderAndTexcoords) {
    const test::TemporaryFolder folder;
    Scene scene = test::everything();
    scene.nodes[4].skin = kNone;
    save_scene(scene, folder / "a.obj");
    const Scene back = load_scene(folder / "a.obj");
    ASSERT_EQ(back.meshes.size(), 1u);
    EXPECT_EQ(back.meshes[0].primitives[0].positions, scene.meshes[0].primitives[0].positions);
    EXPECT_EQ(back.meshes[0].primitives[0].triangles, scene.meshes[0].primitives[0].triangles);
    for (std::size_t i = 0; i < back.meshes[0].primitives[0].texcoords.size(); ++i)
        EXPECT_TRUE(back.meshes[0].primitives[0].texcoords[i].isApprox(
            scene.meshes[0].primitives[0].texcoords[i], 1e-6f));
}

TEST(Ply, RoundTripKeepsPositionsAndTriangles) {
    const test::TemporaryFolder folder;
    Scene scene = test::everything();
    scene.nodes[4].skin = kNone;
    save_scene(scene, folder / "a.ply");
    const Scene back = load_scene(folder / "a.ply");
    ASSERT_EQ(back.meshes.size(), 1u);
    EXPECT_EQ(back.meshes[0].primitives[0].positions, scene.meshes[0].primitives[0].positions);
    EXPECT_EQ(back.meshes[0].primitives[0].triangles, scene.meshes[0].primitives[0].triangles);
}

TEST(Files, UnknownKindsAreRefused) {
    const test::TemporaryFolder folder;
    EXPECT_ERROR((void)load_scene(folder / "a.stl"), "unknown kind");
    EXPECT_ERROR((void)load_scene(folder / "a.glb"), "no such file");
    EXPECT_ERROR(save_scene(test::everything(), folder / "a.fbx"), "are written as");
}

} // namespace
} // namespace toile::assets
