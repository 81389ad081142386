// What we export passes the Khronos validator, without errors or warnings.
#include "assets/files.h"
#include "core/bytes.h"
#include "support/run_program.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <gtest/gtest.h>

namespace toile::assets {
namespace {

struct Verdict {
    int status = -1;
    std::string text;
};

Verdict validate(const std::vector<std::filesystem::path>& files) {
    std::string command = "node '" TOILE_SOURCE_DIR "/tests/gltf/validate.mjs'";
    for (const std::filesystem::path& file : files)
        command += " '" + file.string() + "'";
    command += " 2>&1";
    Verdict verdict;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return verdict;
    std::array<char, 4096> piece{};
    while (std::fgets(piece.data(), piece.size(), pipe) != nullptr)
        verdict.text += piece.data();
    verdict.status = pclose(pipe) / 256;
    return verdict;
}

class GltfValidator : public testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(TOILE_SOURCE_DIR "/tests/gltf/node_modules/gltf-validator"))
            GTEST_SKIP() << "gltf-validator is not installed: run npm ci in tests/gltf";
    }
};

/// Normal maps leave the tangents to the viewer (MikkTSpace), as glTF allows.
constexpr const char* kTangents = "MESH_PRIMITIVE_GENERATED_TANGENT_SPACE";

/// The lines of a verdict but for warnings of one kind.
std::string faults_but(const std::string& warning, const std::string& text) {
    std::string faults;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        if (line.find("warning " + warning) == std::string::npos) faults += line + "\n";
        begin = end + 1;
    }
    return faults;
}

TEST_F(GltfValidator, FindsAFault) {
    const test::TemporaryFolder folder;
    Scene scene = test::everything();
    save_scene(scene, folder / "a.glb");
    std::vector<std::uint8_t> bytes = read_bytes(folder / "a.glb", 1u << 24);
    const std::string wanted = "\"count\":";
    const auto it = std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
    ASSERT_NE(it, bytes.end());
    *(it + 8) = '9'; // an accessor that claims more elements
    write_bytes(folder / "bad.glb", bytes);
    const Verdict verdict = validate({folder / "bad.glb"});
    EXPECT_EQ(verdict.status, 1) << verdict.text;
}

TEST_F(GltfValidator, PassesEverythingWeCanWrite) {
    const test::TemporaryFolder folder;
    save_scene(test::everything(), folder / "a.glb");
    const Verdict verdict = validate({folder / "a.glb"});
    EXPECT_EQ(verdict.status, 0) << verdict.text;
}

TEST_F(GltfValidator, PassesReexportsOfSharedSkins) {
    const std::array<std::pair<const char*, const char*>, 12> files = {{
        {"gltf_skins", "CesiumMan_blender_reexport.glb"},
        {"gltf_skins", "RiggedSimple.glb"},
        {"gltf_skins", "RiggedSimple_blender_reexport.glb"},
        {"gltf_skins", "quad_skin.glb"},
        {"gltf_skins", "simple_skin.gltf"},
        {"gltf_skins", "AnimatedMorphCube/glTF/AnimatedMorphCube.gltf"},
        {"gltf_skins", "AnimatedMorphSphere/glTF/AnimatedMorphSphere.gltf"},
        {"gltf_skins", "MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf"},
        {"gltf_skins", "MorphStressTest/glTF/MorphStressTest.gltf"},
        {"gltf_skins", "SimpleMorph/glTF/SimpleMorph.gltf"},
        {"fbx_skins", "animation_with_skeleton.fbx"},
        {"fbx_skins", "huesitos.fbx"},
    }};
    const test::TemporaryFolder folder;
    std::vector<std::filesystem::path> exported;
    for (const auto& [set_name, name] : files) {
        TOILE_SHARED_DATA_OR_SKIP(set, set_name);
        const std::filesystem::path source = set / name;
        exported.push_back(folder / (source.stem().string() + ".glb"));
        save_scene(load_scene(source), exported.back());
    }
    const Verdict verdict = validate(exported);
    ASSERT_LE(verdict.status, 1) << verdict.text;
    // Files may hang a skinned mesh below other nodes; that warning is theirs and is kept.
    const std::string faults = faults_but("NODE_SKINNED_MESH", verdict.text);
    EXPECT_EQ(faults, "");
}

TEST_F(GltfValidator, PassesTheAvatarsAndGarmentsOfTheRepository) {
    const std::filesystem::path root = TOILE_SOURCE_DIR;
    std::vector<std::filesystem::path> files;
    for (const char* kind : {"avatars", "garments"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / kind))
            if (entry.path().extension() == ".glb") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    ASSERT_GE(files.size(), 9u);
    const Verdict verdict = validate(files);
    ASSERT_LE(verdict.status, 1) << verdict.text;
    EXPECT_EQ(faults_but(kTangents, verdict.text), "");
}

TEST_F(GltfValidator, PassesADressedLook) {
    const test::TemporaryFolder folder;
    const test::ProgramResult tryon =
        test::run_toile({"tryon", "--body", "woman", "--garment", "t-shirt,skirt", "--picture",
                         "90x120", "--quality", "fast", "--out", (folder / "look.png").string(),
                         "--glb", (folder / "look.glb").string()});
    ASSERT_EQ(tryon.status, 0) << tryon.output;
    const Verdict verdict = validate({folder / "look.glb"});
    ASSERT_LE(verdict.status, 1) << verdict.text;
    EXPECT_EQ(faults_but(kTangents, verdict.text), "");
}

} // namespace
} // namespace toile::assets
