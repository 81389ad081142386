// Bits flipped, bytes replaced, ends cut off, pieces repeated: every reader of files from outside
// either reads the file or refuses it in one line.
#include "assets/bvh.h"
#include "assets/files.h"
#include "assets/zip.h"
#include "body/body_file.h"
#include "imaging/capture_folder.h"
#include "support/damage.h"
#include "support/scenes.h"
#include "support/small_space.h"
#include "support/temporary_folder.h"

namespace toile {
namespace {

using test::Bytes;
using test::kRounds;
using test::torture;

assets::Scene small_scene() {
    assets::Scene scene = test::everything();
    return scene;
}

assets::ImportLimits small_limits() {
    assets::ImportLimits limits;
    limits.max_file_bytes = 8u << 20;
    limits.max_decoded_bytes = 64u << 20;
    limits.max_vertices = 100'000;
    limits.max_triangles = 100'000;
    return limits;
}

class SceneFiles : public testing::TestWithParam<const char*> {};

TEST_P(SceneFiles, SurviveDamage) {
    const test::TemporaryFolder folder;
    const auto file = folder / (std::string("scene") + GetParam());
    save_scene(small_scene(), file);
    EXPECT_GT(torture(file, [&] { (void)load_scene(file, small_limits()); }), kRounds / 10);
}

INSTANTIATE_TEST_SUITE_P(All, SceneFiles, testing::Values(".glb", ".obj", ".ply"));

// The JSON part alone, so that most damage hits structure rather than numbers of vertices.
TEST(GltfText, SurvivesDamage) {
    const test::TemporaryFolder folder;
    save_scene(small_scene(), folder / "scene.glb");
    const Bytes glb = read_bytes(folder / "scene.glb", 1u << 24);
    std::uint32_t length = 0;
    std::copy_n(glb.begin() + 12, 4, reinterpret_cast<std::uint8_t*>(&length));
    std::string json(glb.begin() + 20, glb.begin() + 20 + length);
    const std::size_t buffer = json.find("\"buffers\":[{");
    ASSERT_NE(buffer, std::string::npos);
    json.insert(buffer + 12, "\"uri\":\"scene.bin\",");
    write_bytes(folder / "scene.bin", std::span(glb).subspan(28 + length));
    write_text(folder / "scene.gltf", json);
    EXPECT_GT(torture(folder / "scene.gltf",
                      [&] { (void)load_scene(folder / "scene.gltf", small_limits()); }),
              kRounds / 4);
}

TEST(Bvh, SurvivesDamage) {
    const test::TemporaryFolder folder;
    const auto file = folder / "m.bvh";
    write_text(file, "HIERARCHY\nROOT Hips\n{\n OFFSET 0 1 0\n CHANNELS 6 Xposition Yposition "
                     "Zposition Zrotation Xrotation Yrotation\n JOINT Leg\n {\n  OFFSET 1 -2 3\n  "
                     "CHANNELS 3 Yrotation Xrotation Zrotation\n  End Site\n  {\n   OFFSET 0 -5 "
                     "0\n  }\n }\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n0 0 0 0 0 0 0 0 0\n1 2 3 "
                     "90 0 0 0 90 0\n");
    EXPECT_GT(torture(file, [&] { (void)assets::load_bvh(file); }), kRounds / 4);
}

TEST(Zip, SurvivesDamage) {
    const test::TemporaryFolder folder;
    const auto file = folder / "a.zip";
    assets::write_zip({{"garment.json", Bytes(300, '{')},
                       {"meshes/a.glb", Bytes(2000, 9)},
                       {"textures/b.png", Bytes(10, 1)}},
                      file);
    EXPECT_GT(torture(file, [&] { (void)assets::read_zip(file); }), kRounds / 2);
}

TEST(Pictures, SurviveDamage) {
    const test::TemporaryFolder folder;
    const imaging::Image image = test::everything().textures[0].image;
    for (const char* name : {"a.png", "a.jpg"}) {
        const auto file = folder / name;
        save_image(image, file);
        EXPECT_GT(torture(file, [&] { (void)imaging::load_image(file); }), kRounds / 10);
    }
    imaging::save_depth({8, 8, std::vector<float>(64, 1.25f)}, folder / "d.png");
    EXPECT_GT(torture(folder / "d.png", [&] { (void)imaging::load_depth(folder / "d.png"); }),
              kRounds / 4);
}

TEST(BodyFiles, SurviveDamage) {
    const test::TemporaryFolder folder;
    const auto file = folder / "body.json";
    body::BodyFile person;
    person.model = "adult";
    person.model_version = "1.0.0";
    person.made_by = "fit";
    person.sex = body::Sex::male;
    person.coefficients = {0.5, -1.25};
    person.detail = {0.001f, -0.002f, 0.0f};
    person.pose.emplace();
    person.measurements["bust_girth"] = {0.92, 0.8};
    person.fit["frames"] = 5;
    save_body_file(person, file);
    EXPECT_GT(torture(file, [&] { (void)body::load_body_file(file); }), kRounds / 2);
}

TEST(BodySpaces, SurviveDamage) {
    const test::TemporaryFolder folder;
    test::write_space(test::small_model(), folder.path());
    const auto read = [&] {
        const auto space = body::BodySpace::load(folder.path());
        (void)body::load_pose_tables(space.model());
        (void)space.shape(std::vector<double>{2.0, -2.0});
    };
    for (const char* name : {"space.json", "avatar.json", "small.glb"})
        EXPECT_GT(torture(folder / name, read), kRounds / 4) << name;
    // Most of their bytes are weights, of which any are good.
    for (const char* name : {"space.tables", "scape.tables", "baked.tables"})
        EXPECT_GT(torture(folder / name, read), kRounds / 10) << name;
}

TEST(CaptureFolders, SurviveDamage) {
    const test::TemporaryFolder folder;
    const imaging::Intrinsics camera{4, 3, 5.0, 6.0, 1.5, 1.0, {0.1, 0, 0, 0, 0, 0, 0, 0}};
    imaging::CaptureWriter writer(folder / "c", camera, Eigen::Isometry3d::Identity());
    writer.add(0.0, {4, 3, std::vector<float>(12, 1.0f)});
    writer.add(0.1, {4, 3, std::vector<float>(12, 1.0f)});
    for (const char* name : {"c/intrinsic.json", "c/extrinsic.json", "c/timestamps.csv"})
        EXPECT_GT(torture(folder / name, [&] { (void)imaging::open_capture(folder / "c"); }),
                  kRounds / 10)
            << name;
}

} // namespace
} // namespace toile
