// Patches without readings, and things that people carry.
#include "core/bytes.h"
#include "simulated_sensor/simulator.h"
#include "simulated_sensor/tests/stages.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>

namespace toile::simulated_sensor {
namespace {

TEST(Holes, AsManyAsAskedForInPatchesThatWander) {
    Stage stage;
    add(stage, tilted_plane(2.0f, 0.0f));
    stage.commit();
    CameraSettings settings = bare_camera();
    settings.noise.holes = 0.3;
    DepthCamera camera(settings, 1, 0);
    std::vector<bool> before;
    for (const std::uint32_t frame : {0u, 1u}) {
        see(camera, stage, frame);
        std::vector<bool> lost;
        for (const float z : camera.depth().metres)
            lost.push_back(std::isnan(z));
        std::size_t count = 0, changes = 0, both = 0;
        for (std::size_t i = 0; i < lost.size(); ++i) {
            count += lost[i] ? 1 : 0;
            changes += i % 640 != 0 && lost[i] != lost[i - 1] ? 1 : 0;
            both += !before.empty() && lost[i] && before[i] ? 1 : 0;
        }
        const auto all = static_cast<double>(lost.size());
        EXPECT_NEAR(static_cast<double>(count) / all, 0.3, 0.02);
        // Single pixels would change 0.42 times a pixel.
        EXPECT_LT(static_cast<double>(changes) / all, 0.1);
        if (!before.empty()) EXPECT_NEAR(static_cast<double>(both) / all, 0.09, 0.02);
        before = lost;
    }
}

Scenario scenario_with(const test::TemporaryFolder& folder, const std::string& person) {
    write_text(folder / "bag.obj", "v -0.1 -0.1 0\nv 0.1 -0.1 0\nv 0 0.1 0\nf 1 2 3\n");
    write_text(folder / "s.json",
               R"({"schema": 1, "frames": 3, "frames_per_second": 2, "people": [)" + person +
                   R"(], "cameras": [{"name": "front"}]})");
    return load_scenario(folder / "s.json");
}

TEST(Carried, GoesWithItsJoint) {
    const test::TemporaryFolder folder;
    const Scenario scenario =
        scenario_with(folder, R"({"body": {"avatar": "woman"}, "turntable_s": 4, "carries":
                   [{"mesh": "bag.obj", "joint": "leftHand", "position": [0, -0.2, 0]}]})");
    const auto figure = make_figure(scenario.people.at(0));
    std::vector<Vec3f> middles;
    for (const double time_s : {0.0, 1.0}) { // a quarter turn
        figure->pose(time_s);
        const FigureSurface& bag = figure->surfaces().back();
        EXPECT_EQ(bag.role, body::SurfaceRole::other);
        ASSERT_EQ(bag.positions.size(), 3u);
        const RigidTransform& hand =
            (*figure->joints())[static_cast<std::size_t>(body::Joint::left_hand)];
        const Vec3f middle = 0.5f * (bag.positions[0] + bag.positions[1]);
        EXPECT_LT((middle - hand * Vec3f(0, -0.3f, 0)).norm(), 1e-5f);
        middles.push_back(middle);
    }
    EXPECT_NEAR(middles[0].y(), middles[1].y(), 1e-4f);
    EXPECT_NEAR(middles[0].x(), -middles[1].z(), 1e-4f);
    EXPECT_GT(std::abs(middles[0].x()), 0.3f);
}

TEST(Carried, IsRefusedWhereItCannotBe) {
    const test::TemporaryFolder folder;
    EXPECT_ERROR((void)scenario_with(folder, R"({"body": {"avatar": "woman"}, "carries":
                   [{"mesh": "bag.obj", "joint": "tail"}]})"),
                 "'tail' is no joint");
    EXPECT_ERROR((void)scenario_with(folder, R"({"body": {"mesh": "bag.obj"}, "carries":
                   [{"mesh": "bag.obj", "joint": "hips"}]})"),
                 "needs an avatar or a test person");
}

} // namespace
} // namespace toile::simulated_sensor
