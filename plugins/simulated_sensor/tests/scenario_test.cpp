// Scenarios: what is read, and one clear error for each that is wrong.
#include "core/bytes.h"
#include "simulated_sensor/scenario.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>

namespace toile::simulated_sensor {
namespace {

Scenario read(const std::string& text) {
    const test::TemporaryFolder folder;
    write_text(folder / "box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_text(folder / "scenario.json", text);
    return load_scenario(folder / "scenario.json");
}

TEST(Scenario, IsReadWithItsDefaults) {
    const Scenario plain = read(R"({"schema": 1, "cameras": [{}]})");
    EXPECT_EQ(plain.name, "scenario");
    EXPECT_EQ(plain.frames, 1u);
    ASSERT_EQ(plain.cameras.size(), 1u);
    EXPECT_EQ(plain.cameras[0].name, "camera0");
    EXPECT_TRUE(plain.cameras[0].noise.shadow);
    EXPECT_EQ(plain.cameras[0].noise.depth_scale, 0.0);
    // Looks along -Z from in front.
    const Eigen::Isometry3d& pose = plain.cameras[0].world_from_camera;
    EXPECT_TRUE((pose.linear() * Vec3d(0, 0, -1)).isApprox(Vec3d(0, 0, -1)));
}

TEST(Scenario, NoiseOfACameraStandsOverThatOfAll) {
    const Scenario made = read(R"({"schema": 1, "noise": {"preset": "full", "axial": 2},
        "cameras": [{"model": "kinect_v2"}, {"noise": {"preset": "none", "shadow": true}}]})");
    EXPECT_EQ(made.cameras[0].noise.axial, 2.0);
    EXPECT_EQ(made.cameras[0].noise.depth_scale, 0.005);
    EXPECT_FALSE(made.cameras[0].noise.shadow); // a time-of-flight camera has none
    EXPECT_EQ(made.cameras[1].noise.axial, 0.0);
    EXPECT_TRUE(made.cameras[1].noise.shadow);
}

TEST(Scenario, RelativePathsStartAtItsFolder) {
    const Scenario made = read(R"({"schema": 1, "cameras": [{}],
        "people": [{"body": {"mesh": "box.obj"}, "position": [1, 0, 2], "turn_deg": 90}]})");
    EXPECT_EQ(made.people[0].source.filename(), "box.obj");
    EXPECT_NEAR(made.people[0].turn, std::acos(0.0), 1e-12);
}

struct Wrong {
    const char* text;
    const char* error;
};

class WrongScenario : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongScenario, IsRefusedInOneLine) {
    EXPECT_ERROR((void)read(GetParam().text), GetParam().error);
    EXPECT_ERROR((void)read(GetParam().text), "scenario.json");
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongScenario,
    ::testing::Values(
        Wrong{"", "scenario.json"}, Wrong{"[]", "object"}, Wrong{R"({"cameras": [{}]})", "schema"},
        Wrong{R"({"schema": 2, "cameras": [{}]})", "schema"}, Wrong{R"({"schema": 1})", "cameras"},
        Wrong{R"({"schema": 1, "cameras": []})", "there is none"},
        Wrong{R"({"schema": 1, "cameras": [{}], "camera": 1})", "camera"},
        Wrong{R"({"schema": 1, "cameras": [{}], "frames": 0})", "frames"},
        Wrong{R"({"schema": 1, "cameras": [{}], "frames_per_second": 1e999})", "scenario.json"},
        Wrong{R"({"schema": 1, "cameras": [{}], "frames_per_second": NaN})", "scenario.json"},
        Wrong{R"({"schema": 1, "cameras": [{"model": "kinect_v3"}]})", "kinect_v3"},
        Wrong{R"({"schema": 1, "cameras": [{"mount": "sideways"}]})", "sideways"},
        Wrong{R"({"schema": 1, "cameras": [{"position": [0, 1]}]})", "position"},
        Wrong{R"({"schema": 1, "cameras": [{"position": [0, 1, 1e9]}]})", "100 m"},
        Wrong{R"({"schema": 1, "cameras": [{"position": [0, 2, 0], "look_at": [0, 0, 0]}]})",
              "straight"},
        Wrong{R"({"schema": 1, "cameras": [{"name": "../a"}]})", "letters"},
        Wrong{R"({"schema": 1, "cameras": [{"name": "a"}, {"name": "a"}]})", "twice"},
        Wrong{R"({"schema": 1, "cameras": [{"nearest_m": 3, "farthest_m": 2}]})", "beyond"},
        Wrong{R"({"schema": 1, "cameras": [{"noise": {"axail": 1}}]})", "axail"},
        Wrong{R"({"schema": 1, "cameras": [{"noise": {"axial": -1}}]})", "axial"},
        Wrong{R"({"schema": 1, "cameras": [{"noise": {"preset": "some"}}]})", "some"},
        Wrong{R"({"schema": 1, "cameras": [{}], "people": [{}]})", "body"},
        Wrong{R"({"schema": 1, "cameras": [{}], "people": [{"body": {}}]})", "names no body"},
        Wrong{R"({"schema": 1, "cameras": [{}], "people": [{"body": {"avatar": "giant"}}]})",
              "giant"},
        Wrong{R"({"schema": 1, "cameras": [{}], "people": [{"body": {"mesh": "gone.obj"}}]})",
              "gone.obj"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"mesh": "box.obj", "surfaces": "box.obj"}}]})",
              "beside another"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"mesh": "box.obj"}, "motion": "box.obj"}]})",
              "can be posed"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"mesh": "box.obj"}, "skin": "red"}]})",
              "#rrggbb"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"mesh": "box.obj", "shape": [1]}}]})",
              "avatar"},
        Wrong{R"({"schema": 1, "cameras": [{}], "scene": {"objects": [{"mesh": "no.ply"}]}})",
              "no.ply"}));

} // namespace
} // namespace toile::simulated_sensor
