// Bits flipped, bytes replaced, ends cut off, pieces repeated: every reader either reads the file
// or throws an Error of one line. Anything else (crash, other exception, endless work) fails.
#include "assets/bvh.h"
#include "assets/files.h"
#include "assets/zip.h"
#include "body/body_file.h"
#include "core/bytes.h"
#include "core/log.h"
#include "core/random.h"
#include "imaging/capture_folder.h"
#include "support/scenes.h"
#include "support/temporary_folder.h"

#include <functional>
#include <gtest/gtest.h>

namespace toile {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kRounds = 400; // per kind of file

Bytes damaged(const Bytes& good, Random& random) {
    Bytes bytes = good;
    const auto place = [&] { return static_cast<std::size_t>(random.next() % bytes.size()); };
    constexpr std::uint8_t kValues[] = {0, 1, 0x7f, 0x80, 0xff, '-', '9', '"', '}', '\n'};
    const std::uint64_t times = 1 + random.next() % 4;
    for (std::uint64_t i = 0; i < times && !bytes.empty(); ++i) {
        const std::size_t at = place();
        switch (random.next() % 6) {
        case 0:
            bytes[at] ^= static_cast<std::uint8_t>(1u << (random.next() % 8));
            break;
        case 1:
            bytes[at] = kValues[random.next() % std::size(kValues)];
            break;
        case 2:
            bytes.resize(at);
            break;
        case 3: // four bytes at once: counts and offsets of binary files
            for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k)
                bytes[k] = kValues[random.next() % 5];
            break;
        case 4: { // a piece repeated
            const std::size_t length = std::min<std::size_t>(bytes.size() - at, 64);
            const Bytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                              bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), piece.begin(),
                         piece.end());
            break;
        }
        default: // a digit changed, where one stands near
            for (std::size_t k = at; k < bytes.size(); ++k)
                if (bytes[k] >= '0' && bytes[k] <= '9') {
                    bytes[k] = static_cast<std::uint8_t>('0' + random.next() % 10);
                    break;
                }
        }
    }
    return bytes;
}

// Returns how many of the damaged files were refused.
int torture(const std::filesystem::path& file, const std::function<void()>& read) {
    log::set_level(log::Level::error);
    const Bytes good = read_bytes(file, 1u << 24);
    EXPECT_NO_THROW(read());
    Random random(1234);
    int refused = 0;
    for (int round = 0; round < kRounds; ++round) {
        write_bytes(file, damaged(good, random));
        try {
            read();
        } catch (const Error& e) {
            ++refused;
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
        } catch (const std::exception& e) {
            ADD_FAILURE() << "round " << round << ": not an Error: " << e.what();
        }
    }
    log::set_level(log::Level::info);
    return refused;
}

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

TEST(CaptureFolders, SurviveDamage) {
    const test::TemporaryFolder folder;
    const imaging::Intrinsics camera{4, 3, 5.0, 6.0, 1.5, 1.0, {0.1, 0, 0, 0, 0, 0, 0, 0}};
    imaging::CaptureWriter writer(folder / "c", camera, Eigen::Isometry3d::Identity());
    writer.add(0.0, {4, 3, std::vector<float>(12, 1.0f)});
    writer.add(0.1, {4, 3, std::vector<float>(12, 1.0f)});
    for (const char* name : {"c/intrinsic.json", "c/extrinsic.json", "c/timestamps.csv"}) {
        const Bytes good = read_bytes(folder / name, 1u << 20);
        EXPECT_GT(torture(folder / name, [&] { (void)imaging::open_capture(folder / "c"); }),
                  kRounds / 10)
            << name;
        write_bytes(folder / name, good);
    }
}

} // namespace
} // namespace toile
