// Scenarios: what is read, and one clear error for each that is wrong.
#include "simulated_sensor/scenario.h"
#include "support/damage.h"
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

INSTANTIATE_TEST_SUITE_P(
    TypesAndNumbers, WrongScenario,
    ::testing::Values(
        Wrong{R"({"schema": "1", "cameras": [{}]})", "/schema"},
        Wrong{R"({"schema": 1, "cameras": {}})", "/cameras: must be an array"},
        Wrong{R"({"schema": 1, "cameras": [1]})", "/cameras/0: must be an object"},
        Wrong{R"({"schema": 1, "cameras": [{}], "frames": -1})", "/frames: must lie"},
        Wrong{R"({"schema": 1, "cameras": [{}], "frames": 1.5})", "/frames: must be a whole"},
        Wrong{R"({"schema": 1, "cameras": [{}], "frames": 18446744073709551615})", "/frames"},
        Wrong{R"({"schema": 1, "cameras": [{}], "seed": -1})", "/seed"},
        Wrong{R"({"schema": 1, "cameras": [{}], "frames_per_second": -30})", "per_second"},
        Wrong{R"({"schema": 1, "cameras": [{}], "color": 1})", "/color: must be true or false"},
        Wrong{R"({"schema": 1, "cameras": [{}], "name": null})", "/name: must be a text"},
        Wrong{R"({"schema": 1, "cameras": [{}], "a\nb": 1})", "/a?b: is not a known key"},
        Wrong{R"({"schema": 1, "cameras": [{"position": [0, 1, "2"]}]})", "numbers only"},
        Wrong{R"({"schema": 1, "cameras": [{"position": [0, 1, NaN]}]})", "not valid JSON"},
        Wrong{R"({"schema": 1, "cameras": [{"position": [0, 1, -1e999]}]})", "out of range"},
        Wrong{R"({"schema": 1, "cameras": [{"roll_deg": 1e300}]})", "roll_deg"},
        Wrong{R"({"schema": 1, "cameras": [{"look_at": [0, 1, 2.4]}]})", "look_at"},
        Wrong{R"({"schema": 1, "cameras": [{}], "people": [[]]})", "/people/0: must be an object"},
        Wrong{R"({"schema": 1, "cameras": [{}], "people": [{"body": {"avatar": "a\nb"}}]})",
              "no avatar 'a?b'"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"avatar": "adult", "shape": [1e300]}}]})",
              "/shape: has a value beyond"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"avatar": "adult", "shape": -1}}]})",
              "/shape: must be an array"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"avatar": "adult"}, "poses": "box.obj"}]})",
              "/poses: must be an array"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"avatar": "adult"}, "hold_s": -1}]})",
              "/hold_s"},
        Wrong{R"({"schema": 1, "cameras": [{}],
                  "people": [{"body": {"mesh": "box.obj"}, "skin": "#-00001"}]})",
              "#rrggbb"},
        Wrong{R"({"schema": 1, "cameras": [{}], "scene": {"walls": [{"width_m": -2}]}})",
              "/scene/walls/0/width_m"},
        Wrong{R"({"schema": 1, "cameras": [{}], "scene": {"lamp": {"strength": -1}}})",
              "/scene/lamp/strength"}));

TEST(Scenario, ManyOfAKindAndLongNamesAreRefused) {
    const auto cameras = [](int count) {
        std::string text = R"({"schema": 1, "cameras": [{})";
        for (int i = 1; i < count; ++i)
            text += ", {}";
        return text + "]}";
    };
    EXPECT_EQ(read(cameras(16)).cameras.size(), 16u);
    EXPECT_ERROR((void)read(cameras(17)), "/cameras: more than 16");
    const std::string name(5000, 'a'); // more than a file's name may have
    const auto person = [&](const std::string& kind) {
        return R"({"schema": 1, "cameras": [{}], "people": [{"body": {")" + kind + R"(": ")" +
               name + R"("}}]})";
    };
    EXPECT_ERROR((void)read(person("mesh")), "/people/0/body/mesh: there is no");
    EXPECT_ERROR((void)read(person("avatar")), "/people/0/body/avatar: no avatar");
}

TEST(Scenario, SurvivesDamage) {
    const test::TemporaryFolder folder;
    write_text(folder / "box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto file = folder / "scenario.json";
    write_text(file, R"({"schema": 1, "name": "all", "seed": 7, "frames": 3,
        "frames_per_second": 29.5, "color": true,
        "noise": {"preset": "full", "axial": 2, "depth_scale": 0.01, "shadow": false},
        "people": [
          {"body": {"avatar": "adult", "shape": [0.5, -1.25]}, "poses": ["box.obj", "box.obj"],
           "hold_s": 1, "change_s": 0.5, "turntable_s": 8, "position": [0.5, 0, -1],
           "turn_deg": 90, "hair": {"thickness_m": 0.02, "color": "#402010"}, "skin": "#c09080"},
          {"body": {"mesh": "box.obj"}}],
        "scene": {"floor": true, "floor_color": "#808080",
          "walls": [{"position": [0, 0, -2], "turn_deg": 5, "width_m": 4, "height_m": 2.5}],
          "objects": [{"mesh": "box.obj", "position": [1, 0, 1], "color": "#ff0000"}],
          "lamp": {"position": [0, 3, 1], "color": "#ffffff", "strength": 4}, "ambient": 0.5},
        "cameras": [
          {"model": "kinect_v2", "name": "front", "mount": "upright", "position": [0, 1, 2.4],
           "look_at": [0, 1, 0], "roll_deg": 3, "nearest_m": 0.5, "farthest_m": 4.5},
          {"model": "kinect_v1", "position": [0, 1, -2.4], "noise": {"preset": "none"}}]})");
    EXPECT_GT(test::torture(file, [&] { (void)load_scenario(file); }), test::kRounds / 2);
}

} // namespace
} // namespace toile::simulated_sensor
