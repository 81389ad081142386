// toile scan: from pictures to a surface, a report, a rig that moves; and what it refuses.
#include "assets/colored_mesh.h"
#include "assets/files.h"
#include "assets/skins.h"
#include "body/skeleton.h"
#include "core/bytes.h"
#include "core/json.h"
#include "geometry/nearest_surface.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <gmock/gmock.h>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kTurn = R"({"schema": 1, "frames": 33,
    "people": [{"body": {"avatar": "woman"}, "turntable_s": 1.0667}],
    "scene": {"walls": [{"position": [0, 0, -1.5]}]},
    "cameras": [{"name": "front", "mount": "upright", "position": [0, 1.1, 2.1], "look_at": [0, 0.88, 0]}]})";

/// One recording for all tests.
class ScanTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        write_text(*folder_ / "turn.json", kTurn);
        const auto made = run_toile(
            {"record", "--source", "simulated:" + path("turn.json"), "--out", path("turn")});
        ASSERT_EQ(made.status, 0) << made.output;
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string path(const std::string& name) { return (*folder_ / name).string(); }

    static ProgramResult scan(std::vector<std::string> more) {
        std::vector<std::string> words = {"scan", "--source", "capture:" + path("turn")};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words);
    }
    static geometry::TriangleMesh truth() {
        return assets::load_colored_mesh(*folder_ / "turn" / "truth" / "surfaces.glb").mesh;
    }

    static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(ScanTest, ATurningWomanComesOutAsSheStoodFirst) {
    const auto done = scan({"--out", path("woman.ply"), "--report", path("woman.json"),
                            "--triangles", "40000", "--threads", "2"});
    ASSERT_EQ(done.status, 0) << done.output;
    const auto report = parse_json_file(path("woman.json"));
    EXPECT_EQ(report.at("method"), "fusion");
    EXPECT_EQ(report.at("frames"), 33);
    EXPECT_TRUE(report.at("loop").at("closed"));
    EXPECT_LT(report.at("loop").at("error_m"), 0.002);
    EXPECT_LE(report.at("triangles"), 40000);
    EXPECT_THAT(done.output, testing::Not(HasSubstr("made up")));
    const auto scanned = assets::load_colored_mesh(path("woman.ply"));
    ASSERT_EQ(scanned.colors.size(), scanned.mesh.positions.size());
    const auto topology = geometry::check_topology(scanned.mesh.positions, scanned.mesh.triangles);
    EXPECT_TRUE(topology.closed()) << topology.text();
    const auto woman = truth();
    const geometry::NearestSurface surface(woman.positions, woman.triangles);
    std::vector<float> off;
    double mean = 0.0;
    for (const Vec3f& p : scanned.mesh.positions) {
        off.push_back(surface.nearest(p).distance);
        mean += off.back() / static_cast<double>(scanned.mesh.positions.size());
    }
    std::sort(off.begin(), off.end());
    EXPECT_LT(mean, 0.0015);
    EXPECT_LT(off[off.size() * 95 / 100], 0.005);
}

TEST_F(ScanTest, AnyNumberOfThreadsGivesTheSameFile) {
    ASSERT_EQ(scan({"--out", path("one.ply"), "--threads", "1", "--frames", "12"}).status, 0);
    ASSERT_EQ(scan({"--out", path("two.ply"), "--threads", "2", "--frames", "12"}).status, 0);
    EXPECT_EQ(read_bytes(path("one.ply"), 1u << 28), read_bytes(path("two.ply"), 1u << 28));
}

TEST_F(ScanTest, ATextureKeepsWhatACoarseSurfaceCannot) {
    const auto texture_of = [&](const std::string& name) {
        return assets::load_scene(path(name)).textures.at(0).image;
    };
    ASSERT_EQ(scan({"--out", path("full.ply"), "--threads", "2"}).status, 0);
    const auto full = assets::load_colored_mesh(path("full.ply"));
    const geometry::NearestSurface surface(full.mesh.positions, full.mesh.triangles);
    for (const auto& [name, threads] : {std::pair{"paint.glb", "2"}, {"paint.obj", "1"}}) {
        const auto done = scan({"--out", path(name), "--triangles", "3000", "--texture", "1024",
                                "--threads", threads, "--report", path("paint.json")});
        ASSERT_EQ(done.status, 0) << done.output;
        const auto report = parse_json_file(path("paint.json")).at("texture");
        EXPECT_EQ(report.at("side"), 1024);
        EXPECT_LT(report.at("charts"), 300);
        const auto scene = assets::load_scene(path(name));
        ASSERT_EQ(scene.textures.size(), 1u) << name;
        const auto& part = scene.meshes.at(0).primitives.at(0);
        ASSERT_LE(part.triangles.size(), 3000u);
        std::vector<int> off;
        for (const Triangle& t : part.triangles) { // at the middle of each triangle
            Vec2f uv = Vec2f::Zero();
            Vec3f p = Vec3f::Zero();
            for (const std::uint32_t v : t) {
                uv += part.texcoords[v] / 3.0f;
                p += part.positions[v] / 3.0f;
            }
            const auto near = surface.nearest(p);
            const auto seen = assets::texture_color(scene.textures[0].image, uv);
            for (std::size_t c = 0; c < 3; ++c) {
                float wanted = 0.0f;
                for (std::size_t k = 0; k < 3; ++k)
                    wanted +=
                        near.barycentric[static_cast<Eigen::Index>(k)] *
                        static_cast<float>(full.colors[full.mesh.triangles[near.triangle][k]][c]);
                off.push_back(std::abs(static_cast<int>(seen[c]) - static_cast<int>(wanted)));
            }
        }
        std::sort(off.begin(), off.end());
        EXPECT_LE(off[off.size() * 95 / 100], 6) << name;
    }
    // Painted by one thread and by two.
    EXPECT_EQ(texture_of("paint.glb").pixels, texture_of("paint.obj").pixels);
}

TEST_F(ScanTest, ARiggedScanMovesWithoutTearing) {
    const auto done =
        scan({"--out", path("rig.glb"), "--rig", "--triangles", "30000", "--texture", "--motion",
              std::string(TOILE_SOURCE_DIR) + "/avatars/motions/walk.json"});
    ASSERT_EQ(done.status, 0) << done.output;
    assets::Scene scene = assets::load_scene(path("rig.glb"));
    ASSERT_EQ(scene.skins.size(), 1u);
    EXPECT_EQ(scene.skins[0].joints.size(), body::kJointCount);
    ASSERT_EQ(scene.animations.size(), 1u);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].image.width, 2048);
    EXPECT_EQ(scene.meshes.at(0).primitives.at(0).texcoords.size(),
              scene.meshes.at(0).primitives.at(0).weights.size());
    const auto& primitive = scene.meshes.at(0).primitives.at(0);
    // As it stands every vertex is where it is.
    const auto still =
        assets::skinned_positions(primitive, scene.skins[0], assets::node_transforms(scene));
    for (std::size_t v = 0; v < still.size(); ++v)
        ASSERT_LT((still[v] - primitive.positions[v]).norm(), 1e-4f);
    // And at each tenth frame of the walk hardly any side is torn.
    const auto& channels = scene.animations[0].channels;
    for (std::size_t k = 0; k < channels.front().values.size(); k += 10) {
        for (const assets::Channel& channel : channels) {
            assets::Node& node = scene.nodes.at(static_cast<std::size_t>(channel.node));
            const Vec4f& value = channel.values.at(k);
            if (channel.path == assets::Channel::Path::rotation)
                node.rotation = Quatf(value.w(), value.x(), value.y(), value.z());
            else
                node.translation = value.head<3>();
        }
        const auto moved =
            assets::skinned_positions(primitive, scene.skins[0], assets::node_transforms(scene));
        std::size_t torn = 0;
        for (const Triangle& t : primitive.triangles)
            for (std::size_t i = 0; i < 3; ++i) {
                const auto a = t[i], b = t[(i + 1) % 3];
                const float before = (primitive.positions[a] - primitive.positions[b]).norm();
                torn += (moved[a] - moved[b]).norm() > 3.0f * before + 0.01f ? 1 : 0;
            }
        EXPECT_EQ(torn, 0u) << "frame " << k;
    }
}

/// Distances of a scan's vertices from the true surface of the first frame: mean and 95 %.
std::pair<double, double> off_the_truth(const fs::path& scan, const fs::path& recording) {
    const auto scanned = assets::load_colored_mesh(scan).mesh;
    const auto truth = assets::load_colored_mesh(recording / "truth" / "surfaces.glb").mesh;
    const geometry::NearestSurface surface(truth.positions, truth.triangles);
    std::vector<float> off;
    double mean = 0.0;
    for (const Vec3f& p : scanned.positions) {
        off.push_back(surface.nearest(p).distance);
        mean += static_cast<double>(off.back()) / static_cast<double>(scanned.positions.size());
    }
    std::sort(off.begin(), off.end());
    return {mean, off[off.size() * 95 / 100]};
}

/// Arms that go up and down by some 25 degrees while the trunk sways.
constexpr const char* kRestless = R"({"schema": 1, "name": "restless", "legs": "follow", "keys": [
    {"time_s": 0, "rotations_deg": {"leftUpperArm": [0, 0, -45], "rightUpperArm": [0, 0, 45]}},
    {"time_s": 4, "hips_offset_m": [0.015, 0, 0.01], "rotations_deg": {"spine": [2, 2, 2],
        "leftUpperArm": [0, 8, -60], "rightUpperArm": [0, -8, 50], "head": [0, 10, 0]}},
    {"time_s": 8, "hips_offset_m": [-0.015, 0, 0], "rotations_deg": {"spine": [-2, 0, -2],
        "leftUpperArm": [0, 0, -35], "rightUpperArm": [0, 10, 65]}},
    {"time_s": 12, "hips_offset_m": [0.01, 0, -0.01], "rotations_deg": {"spine": [0, 3, 1],
        "leftUpperArm": [0, -8, -55], "rightUpperArm": [0, 0, 40], "head": [0, -10, 0]}},
    {"time_s": 16, "rotations_deg": {"leftUpperArm": [0, 0, -45], "rightUpperArm": [0, 0, 45]}}]})";

constexpr const char* kCameras = R"("scene": {"walls": [{"position": [0, 0, -1.5]}]},
    "cameras": [{"name": "front", "mount": "upright", "position": [0, 1.1, 2.1], "look_at": [0, 0.88, 0]}]})";

TEST(MovingScanTest, AWomanWhoSwaysAndMovesTheArmsWhileTurningComesOutAsSheStoodFirst) {
    const TemporaryFolder folder;
    write_text(folder / "restless.json", kRestless);
    write_text(folder / "turn.json",
               std::string(R"({"schema": 1, "frames": 33, "frames_per_second": 2,
        "people": [{"body": {"avatar": "woman"}, "turntable_s": 16, "motion": "restless.json",
                    "breath_m": 0.006}],)") +
                   kCameras);
    ASSERT_EQ(run_toile({"record", "--source", "simulated:" + (folder / "turn.json").string(),
                         "--out", (folder / "turn").string()})
                  .status,
              0);
    const auto done = run_toile({"scan", "--source", "capture:" + (folder / "turn").string(),
                                 "--method", "turntable", "--out", (folder / "scan.ply").string(),
                                 "--report", (folder / "scan.json").string()});
    ASSERT_EQ(done.status, 0) << done.output;
    const auto report = parse_json_file(folder / "scan.json");
    EXPECT_EQ(report.at("template"), "body");
    EXPECT_EQ(report.at("frames_lost"), 0);
    const auto [mean, most] = off_the_truth(folder / "scan.ply", folder / "turn");
    EXPECT_LT(mean, 0.005);
    EXPECT_LT(most, 0.015);
}

TEST(MovingScanTest, ArmsMovedFreelyComeOutInOnePoseAndEachIterationHelps) {
    const TemporaryFolder folder;
    write_text(folder / "restless.json", kRestless);
    write_text(folder / "free.json",
               std::string(R"({"schema": 1, "frames": 17, "frames_per_second": 2,
        "people": [{"body": {"avatar": "woman"}, "motion": "restless.json"}],)") +
                   kCameras);
    ASSERT_EQ(run_toile({"record", "--source", "simulated:" + (folder / "free.json").string(),
                         "--out", (folder / "free").string()})
                  .status,
              0);
    const auto done = run_toile({"scan", "--source", "capture:" + (folder / "free").string(),
                                 "--method", "articulated", "--out", (folder / "scan.ply").string(),
                                 "--report", (folder / "scan.json").string()});
    ASSERT_EQ(done.status, 0) << done.output;
    const auto residuals =
        parse_json_file(folder / "scan.json").at("residuals_m").get<std::vector<double>>();
    ASSERT_GE(residuals.size(), 2u);
    for (std::size_t k = 1; k < residuals.size(); ++k)
        EXPECT_LE(residuals[k], residuals[k - 1]);
    EXPECT_LT(off_the_truth(folder / "scan.ply", folder / "free").first, 0.010);
}

TEST_F(ScanTest, SaysWhenMuchOfTheSurfaceWasSeenByNobody) {
    const auto half = scan({"--out", path("half.ply"), "--frames", "4"});
    ASSERT_EQ(half.status, 0) << half.output;
    EXPECT_THAT(half.output, HasSubstr("% of the surface, it is made up"));
}

TEST_F(ScanTest, RefusesWhatCannotBeDone) {
    const auto refused = [&](std::vector<std::string> words, int status, const char* text) {
        const auto result = scan(std::move(words));
        EXPECT_EQ(result.status, status) << result.output;
        EXPECT_THAT(result.output, HasSubstr(text));
    };
    refused({"--out", path("a.stl")}, 2, "name a .ply, .glb or .obj file");
    refused({"--out", path("no/a.ply")}, 2, "does not exist");
    refused({"--out", path("a.ply"), "--report", path("no/a.json")}, 2, "does not exist");
    refused({"--out", path("a.ply"), "--method", "magic"}, 2, "there are fusion");
    refused({"--out", path("a.ply"), "--set", "magic=1"}, 2, "voxel_m");
    refused({"--out", path("a.ply"), "--set", "voxel_m=7"}, 2, "must lie in");
    refused({"--out", path("a.ply"), "--rig"}, 2, "only a .glb holds a skeleton");
    refused({"--out", path("a.ply"), "--texture"}, 2, "a .ply holds none");
    refused({"--out", path("a.glb"), "--texture", "100"}, 2, "256");
    refused({"--out", path("a.obj"), "--texture", "--picture", path("a_texture.png")}, 2,
            "the texture goes there");
    refused({"--out", path("a.glb"), "--motion", "x.bvh"}, 2, "needs --rig");
    refused({"--out", path("a.ply"), "--frames", "1"}, 1, "a single view shows one side only");
    EXPECT_FALSE(fs::exists(path("a.ply")));
    write_text(*folder_ / "empty.json",
               R"({"schema": 1, "frames": 3, "people": [], "cameras": [{"name": "front"}]})");
    const auto nobody =
        run_toile({"scan", "--source", "simulated:" + path("empty.json"), "--out", path("a.ply")});
    EXPECT_EQ(nobody.status, 1);
    EXPECT_THAT(nobody.output, HasSubstr("nobody is in view"));
}

} // namespace
} // namespace toile::test
