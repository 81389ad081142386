// Whole scenarios: what cameras report lies on the people they saw.
#include "core/bytes.h"
#include "geometry/nearest_surface.h"
#include "simulated_sensor/simulator.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>

namespace toile::simulated_sensor {
namespace {

Scenario scenario_of(const std::string& text) {
    const test::TemporaryFolder folder;
    write_text(folder / "scenario.json", text);
    return load_scenario(folder / "scenario.json");
}

const std::string kAvatar = std::string(TOILE_SOURCE_DIR) + "/avatars/mannequin";

/// A mannequin on a turntable seen by two cameras; `noise` is the whole object.
Scenario turning(const std::string& noise, int frames = 3) {
    return scenario_of(R"({"schema": 1, "seed": 3, "frames": )" + std::to_string(frames) +
                       R"(, "noise": )" + noise + R"(, "people": [{"body": {"avatar": ")" +
                       kAvatar + R"("}, "turntable_s": 0.5, "position": [0.1, 0, -0.2]}],
        "cameras": [{"position": [0, 1, 2.4]},
                    {"model": "kinect_v2", "mount": "upright", "position": [2, 0.9, 0.3],
                     "look_at": [0, 0.9, 0]}]})");
}

TEST(Simulator, PointsSeenLieOnThePerson) {
    Simulator simulator(turning(R"({"preset": "none"})"));
    for (const std::uint32_t frame : {0u, 2u}) {
        simulator.show(frame);
        const FigureSurface& body = simulator.figures()[0]->surfaces()[0];
        const geometry::NearestSurface nearest(body.positions, body.surface.triangles);
        for (std::size_t c = 0; c < simulator.camera_count(); ++c) {
            simulator.see(c);
            const DepthCamera& camera = simulator.camera(c);
            const imaging::DepthUnprojector unprojector(camera.intrinsics());
            std::vector<Vec3f> points(camera.depth().metres.size());
            unprojector.points(camera.depth().metres, points);
            std::size_t on_body = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (!points[i].allFinite()) continue;
                const Vec3f p = (camera.reported_pose() * points[i].cast<double>()).cast<float>();
                if (p.y() < 0.01f) continue; // the floor
                ++on_body;
                ASSERT_LT(nearest.nearest(p).distance, 0.0008f); // half a millimetre of rounding
            }
            EXPECT_GT(on_body, 12000u);
        }
    }
}

TEST(Simulator, JointsOfTheTruthLieWithinTheBody) {
    Simulator simulator(turning("{}"));
    simulator.show(1);
    const auto people = simulator.people();
    ASSERT_EQ(people.size(), 1u);
    const FigureSurface& body = simulator.figures()[0]->surfaces()[0];
    const geometry::NearestSurface nearest(body.positions, body.surface.triangles);
    for (const RigidTransform& joint : people[0].joints)
        EXPECT_LT(nearest.nearest(joint.translation).signed_distance, 0.005f);
}

TEST(Simulator, AFrameIsTheSameWheneverItIsShown) {
    Simulator once(turning(R"({"preset": "full"})"));
    Simulator again(turning(R"({"preset": "full"})"));
    once.show(2);
    once.see(0);
    for (const std::uint32_t frame : {0u, 1u, 2u}) {
        again.show(frame);
        again.see(1);
        again.see(0);
    }
    EXPECT_EQ(std::memcmp(once.camera(0).depth().metres.data(),
                          again.camera(0).depth().metres.data(),
                          once.camera(0).depth().metres.size() * sizeof(float)),
              0);
    EXPECT_EQ(once.picture(0).pixels, again.picture(0).pixels);
}

TEST(Simulator, ReportedPosesAreOffOnlyWithSystematicErrors) {
    const Simulator usual(turning(R"({"preset": "usual"})"));
    const Simulator full(turning(R"({"preset": "full"})"));
    const auto& stands = usual.camera(0).settings().world_from_camera;
    EXPECT_TRUE(usual.camera(0).reported_pose().isApprox(stands));
    const double off = (full.camera(0).reported_pose().translation() - stands.translation()).norm();
    EXPECT_GT(off, 1e-4);
    EXPECT_LT(off, 0.03);
}

TEST(Simulator, ColourShowsTheLampTheSkinAndTheShadow) {
    const Scenario scenario = scenario_of(R"({"schema": 1, "noise": {"preset": "none"},
        "people": [{"body": {"avatar": ")" +
                                          kAvatar + R"("}, "skin": "#c08060", "hair": {}}],
        "scene": {"walls": [{"position": [0, 0, -1]}]},
        "cameras": [{"position": [0, 1.2, 2.2]}]})");
    Simulator simulator(scenario);
    simulator.show(0);
    simulator.see(0);
    const imaging::Image& picture = simulator.picture(0);
    const DepthCamera& camera = simulator.camera(0);
    Vec3f skin = Vec3f::Zero();
    Vec3f hair = Vec3f::Zero();
    float skin_count = 0.0f;
    float hair_count = 0.0f;
    for (std::size_t i = 0; i < camera.hits().depth.size(); ++i) {
        if (!std::isfinite(camera.hits().depth[i])) continue;
        const Surface& surface = simulator.stage().surface(camera.hits().surface[i]);
        const Vec3f rgb(picture.pixels[4 * i], picture.pixels[4 * i + 1],
                        picture.pixels[4 * i + 2]);
        if (surface.look.grain == Grain::skin) skin += rgb, skin_count += 1.0f;
        if (surface.look.grain == Grain::hair) hair += rgb, hair_count += 1.0f;
    }
    ASSERT_GT(skin_count, 10000.0f);
    ASSERT_GT(hair_count, 100.0f);
    skin /= skin_count;
    hair /= hair_count;
    EXPECT_GT(skin.x(), skin.y() + 15.0f); // the tone that was asked for
    EXPECT_GT(skin.y(), skin.z() + 5.0f);
    EXPECT_GT(skin.sum(), hair.sum() + 100.0f);
}

TEST(Simulator, AMeshHasNoJointsAndIsSeenWhereItStands) {
    const test::TemporaryFolder folder;
    write_text(folder / "tile.obj", "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nf 1 2 3\nf 1 3 4\n");
    write_text(folder / "scenario.json", R"({"schema": 1, "noise": {"preset": "none"},
        "scene": {"floor": false}, "color": false,
        "people": [{"body": {"mesh": "tile.obj"}, "position": [0, 0, -1]}],
        "cameras": [{"position": [0, 1, 1]}]})");
    Simulator simulator(load_scenario(folder / "scenario.json"));
    EXPECT_ERROR(simulator.see(0), "no frame");
    simulator.show(0);
    simulator.see(0);
    EXPECT_TRUE(simulator.people().empty());
    EXPECT_TRUE(simulator.picture(0).empty());
    const auto& depth = simulator.camera(0).depth();
    EXPECT_FLOAT_EQ(depth.metres[static_cast<std::size_t>(640 * 240 + 320)], 2.0f);
}

TEST(Simulator, ACacheIsSeenAsItWasKept) {
    const test::TemporaryFolder folder;
    const geometry::TriangleMesh box = test::box(Vec3f(-0.3f, 0, -0.1f), Vec3f(0.3f, 2, 0.1f));
    assets::Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].name = "box";
    scene.nodes[0].mesh = 0;
    assets::Primitive primitive;
    primitive.positions = box.positions;
    primitive.triangles = box.triangles;
    scene.meshes = {{"box", {primitive}, {}}};
    body::SurfaceCacheWriter writer(folder / "cache", scene, {body::SurfaceRole::body});
    body::TrackedPerson person;
    person.id = 1;
    person.state = body::TrackState::tracked;
    for (int frame = 0; frame < 3; ++frame) {
        std::vector<Vec3f> moved = box.positions;
        for (Vec3f& p : moved)
            p.z() += 0.2f * static_cast<float>(frame);
        const std::array<std::span<const Vec3f>, 1> positions = {moved};
        writer.add(frame / 30.0, std::span(&person, 1), positions);
    }
    write_text(folder / "scenario.json", R"({"schema": 1, "noise": {"preset": "none"}, "frames": 4,
        "scene": {"floor": false}, "people": [{"body": {"surfaces": "cache"}}],
        "cameras": [{"position": [0, 1, 3]}]})");
    Simulator simulator(load_scenario(folder / "scenario.json"));
    for (const std::uint32_t frame : {1u, 0u, 2u, 3u}) { // the last one stays
        simulator.show(frame);
        simulator.see(0);
        const float expected = 2.9f - 0.2f * static_cast<float>(std::min(frame, 2u));
        EXPECT_NEAR(simulator.camera(0).depth().metres[static_cast<std::size_t>(640 * 240 + 320)],
                    expected, 1e-4f);
        EXPECT_EQ(simulator.people().size(), 1u);
    }
}

TEST(Simulator, WrongFilesAreNamed) {
    const test::TemporaryFolder folder;
    write_text(folder / "empty.obj", "# nothing\n");
    const auto with = [&](const std::string& body) {
        write_text(folder / "scenario.json",
                   R"({"schema": 1, "cameras": [{}], "people": [{"body": )" + body + "}]}");
        Simulator simulator(load_scenario(folder / "scenario.json"));
    };
    EXPECT_ERROR(with(R"({"mesh": "empty.obj"})"), "empty.obj");
    EXPECT_ERROR(with(R"({"surfaces": "."})"), "surface cache");
    EXPECT_ERROR(with(R"({"test_person": "."})"), "person.json");
    EXPECT_ERROR(with(R"({"avatar": ")" + kAvatar + R"(", "shape": [1, 2, 3]})"), "coefficients");
}

} // namespace
} // namespace toile::simulated_sensor
