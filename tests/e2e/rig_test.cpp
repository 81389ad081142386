// toile scan with several cameras: calibrated by a ball and by a person, then scanned together.
#include "assets/colored_mesh.h"
#include "core/bytes.h"
#include "geometry/nearest_surface.h"
#include "imaging/rig_file.h"
#include "support/ball_motion.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kCameras =
    R"("cameras": [{"name": "front", "mount": "upright", "position": [0.05, 1.1, 2.2], "look_at": [0, 0.9, 0]},
                   {"name": "side", "mount": "upright", "position": [2.1, 1.0, 0.1], "look_at": [0, 0.92, 0]}],
       "color": false, "schema": 1)";

/// One recording of a ball and one of a turning woman for all tests.
class RigTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        BallMotion motion;
        motion.frames = 30;
        motion.low = Vec3f(-0.5f, 0.6f, -0.5f);
        motion.high = Vec3f(0.5f, 1.4f, 0.5f);
        write_ball_motion(*folder_ / "ball.cache", motion);
        record("ball", R"("frames": 30, "people": [{"body": {"surfaces": "ball.cache"}}])");
        record("turn",
               R"("frames": 37, "people": [{"body": {"avatar": "woman"}, "turntable_s": 1.2}])");
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static void record(const std::string& name, const std::string& scene) {
        write_text(*folder_ / (name + ".json"), "{" + scene + ", " + kCameras + "}");
        const auto made = run_toile(
            {"record", "--source", "simulated:" + path(name + ".json"), "--out", path(name)});
        ASSERT_EQ(made.status, 0) << made.output;
    }
    static std::string path(const std::string& name) { return (*folder_ / name).string(); }

    static ProgramResult scan(const std::string& capture, std::vector<std::string> more) {
        std::vector<std::string> words = {"scan", "--source", "capture:" + path(capture)};
        words.insert(words.end(), more.begin(), more.end());
        return run_toile(words);
    }

    /// How far the second camera is from where it stands to the first: metres, degrees.
    static std::pair<double, double> off(const std::string& rig_file) {
        const imaging::RigFile rig = imaging::load_rig(path(rig_file));
        std::vector<Eigen::Isometry3d> truth;
        for (const char* name : {"front", "side"}) {
            const fs::path file = *folder_ / "ball" / name / "truth_camera.json";
            const nlohmann::json json = parse_json_file(file);
            JsonObject root(json, file.string());
            truth.push_back(imaging::read_rigid_motion(root, "world_from_camera"));
        }
        const Eigen::Isometry3d wanted = truth[0].inverse() * truth[1];
        const Eigen::Isometry3d found =
            rig.cameras.at(0).world_from_camera.inverse() * rig.cameras.at(1).world_from_camera;
        return {(wanted.translation() - found.translation()).norm(),
                Eigen::AngleAxisd(wanted.linear().transpose() * found.linear()).angle() * 57.29578};
    }

    static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(RigTest, AMovedBallTellsWhereCamerasStandAndTheyScanTogether) {
    const auto done = scan("ball", {"--calibrate", "ball", "--out", path("ball_rig.json")});
    ASSERT_EQ(done.status, 0) << done.output;
    const auto rig = imaging::load_rig(path("ball_rig.json"));
    EXPECT_EQ(rig.method, "ball");
    EXPECT_EQ(rig.cameras.at(0).name, "camera0");
    EXPECT_NEAR(rig.report.at("radius_m").get<double>(), 0.1, 0.002);
    EXPECT_GT(rig.report.at("cameras").at(1).at("places").get<int>(), 20);
    const auto [metres, degrees] = off("ball_rig.json");
    EXPECT_LT(metres, 0.006);
    EXPECT_LT(degrees, 0.2);

    const auto scanned =
        scan("turn", {"--extrinsics", path("ball_rig.json"), "--out", path("woman.ply"), "--report",
                      path("woman.json"), "--triangles", "30000"});
    ASSERT_EQ(scanned.status, 0) << scanned.output;
    const auto report = parse_json_file(path("woman.json"));
    EXPECT_EQ(report.at("cameras"), 2);
    EXPECT_EQ(report.at("frames"), 37);
    EXPECT_NEAR(report.at("turn_deg").get<double>(), 360.0, 20.0);
    const auto mesh = assets::load_colored_mesh(path("woman.ply")).mesh;
    const auto topology = geometry::check_topology(mesh.positions, mesh.triangles);
    EXPECT_TRUE(topology.closed()) << topology.text();
    const auto woman = assets::load_colored_mesh(*folder_ / "turn" / "truth" / "surfaces.glb").mesh;
    const geometry::NearestSurface surface(woman.positions, woman.triangles);
    double mean = 0.0; // as it stands: the first camera knew its place
    for (const Vec3f& p : mesh.positions)
        mean += surface.nearest(p).distance / static_cast<double>(mesh.positions.size());
    EXPECT_LT(mean, 0.003);
}

TEST_F(RigTest, ATurningPersonTellsItAsWell) {
    const auto done = scan("turn", {"--calibrate", "person", "--out", path("person_rig.json")});
    ASSERT_EQ(done.status, 0) << done.output;
    const auto [metres, degrees] = off("person_rig.json");
    EXPECT_LT(metres, 0.008);
    EXPECT_LT(degrees, 0.2);
}

TEST_F(RigTest, SaysWhatIsWrong) {
    const auto refused = [&](const ProgramResult& result, int status, const char* text) {
        EXPECT_EQ(result.status, status) << result.output;
        EXPECT_THAT(result.output, HasSubstr(text));
    };
    refused(scan("turn", {"--calibrate", "ball", "--out", path("a.json")}), 1,
            "no picture shows a ball");
    refused(scan("ball/front", {"--calibrate", "ball", "--out", path("a.json")}), 2,
            "a single camera needs none");
    refused(scan("ball", {"--calibrate", "ball", "--out", path("a.ply")}), 2, "name a .json file");
    refused(scan("ball", {"--calibrate", "ball", "--out", path("no/a.json")}), 2, "does not exist");
    refused(scan("ball", {"--calibrate", "ball", "--frames", "5", "--out", path("a.json")}), 1,
            "at least 8 are needed");
    imaging::RigFile three;
    three.method = "ball";
    three.cameras.resize(3);
    save_rig(three, path("three.json"));
    refused(scan("turn", {"--extrinsics", path("three.json"), "--out", path("a.ply")}), 2,
            "is of 3 cameras, the sources have 2");
    fs::copy(path("turn"), path("lost"), fs::copy_options::recursive);
    fs::remove(path("lost") + "/side/extrinsic.json");
    refused(scan("lost", {"--out", path("a.ply")}), 1,
            "camera 2 of 2 does not know where it stands");
    EXPECT_FALSE(fs::exists(path("a.json")));
    EXPECT_FALSE(fs::exists(path("a.ply")));
}

} // namespace
} // namespace toile::test
