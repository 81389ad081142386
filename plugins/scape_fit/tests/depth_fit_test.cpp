// Depth pictures in, people out.
#include "room_cameras.h"
#include "scape_fit/person_finder.h"
#include "support/throws.h"

namespace toile::scape_fit {
namespace {

std::vector<FitCamera> four_sides() {
    return {camera_at(Vec3f(0.0f, 1.0f, 2.4f)), camera_at(Vec3f(2.4f, 1.0f, 0.0f)),
            camera_at(Vec3f(0.0f, 1.0f, -2.4f)), camera_at(Vec3f(-2.4f, 1.0f, 0.0f))};
}

FitSession& session() {
    static FitSession one(adult());
    return one;
}

void show(const std::vector<FitCamera>& cameras, const geometry::TriangleMesh* person) {
    std::vector<imaging::DepthImage> depths;
    for (const FitCamera& camera : cameras)
        depths.push_back(depth_of(camera, person));
    session().add_instant(std::move(depths));
}

/// Mean distance of the true skin from what was found, millimetres; hands, face and feet apart.
double error_mm(const Somebody& who, const PosedLevel& found) {
    const FitLevel& full = adult().level(0);
    std::vector<Vec3f> skin;
    for (std::size_t v = 0; v < full.vertices.size(); ++v)
        if (full.trust[v] > 0.99f && who.surface.positions[v].y() > 0.1f)
            skin.push_back(who.surface.positions[v]);
    return 1000.0 * mean_distance(skin, {found.positions, {}, full.triangles});
}

TEST(DepthFit, FourSidesGiveTheBody) {
    const Somebody who;
    session().begin(four_sides());
    show(four_sides(), &who.surface);
    session().fit({}, &serial_rows);
    EXPECT_LT(error_mm(who, session().surface(0)), 2.5) << session().report().dump(1);
    EXPECT_TRUE(session().report().at("floor_found").get<bool>());
    EXPECT_GT(session().report().at("seen_share").get<double>(), 0.8);
}

/// The podium was taken for part of the body, and the fit refused.
TEST(DepthFit, APodiumIsFloor) {
    const Somebody who;
    geometry::TriangleMesh raised = who.surface;
    for (Vec3f& p : raised.positions)
        p.y() += 0.06f;
    add(raised, test::box(Vec3f(-0.45f, 0.0f, -0.45f), Vec3f(0.45f, 0.06f, 0.45f)));
    session().begin(four_sides());
    show(four_sides(), &raised);
    session().fit({}, &serial_rows);
    PosedLevel found = session().surface(0);
    for (Vec3f& p : found.positions)
        p.y() -= 0.06f;
    EXPECT_LT(error_mm(who, found), 3.0) << session().report().dump(1);
}

TEST(DepthFit, ACameraThatIsOffIsPutRight) {
    const Somebody who;
    std::vector<FitCamera> cameras = four_sides(), told = cameras;
    told[1].world_from_camera->pretranslate(Vec3d(0.0, 0.0, 0.012));
    session().begin(told);
    show(cameras, &who.surface);
    session().fit({}, &serial_rows);
    const CameraCorrection& camera = session().result().state.cameras[1];
    EXPECT_NEAR(camera.shift.z() + 2.4 * camera.turn.y(), -0.012, 0.006);
    EXPECT_LT(error_mm(who, session().surface(0)), 4.0);
}

TEST(DepthFit, OneCameraThatDoesNotKnowWhereItStands) {
    const Somebody who;
    const FitCamera camera = camera_at(Vec3f(0.0f, 1.0f, 2.6f));
    FitCamera lost = camera;
    lost.world_from_camera.reset();
    session().begin({lost});
    session().add_instant({depth_of(camera, &who.surface)});
    session().fit({}, &serial_rows);
    // In the camera's own frame.
    PosedLevel found = session().surface(0);
    for (Vec3f& p : found.positions)
        p = camera.world_from_camera->cast<float>() * p;
    std::vector<Vec3f> front;
    std::vector<Vec3f> normals(who.surface.positions.size());
    geometry::vertex_normals(who.surface.positions, who.surface.triangles, normals);
    for (std::size_t v = 0; v < normals.size(); ++v)
        if (normals[v].z() > 0.4f) front.push_back(who.surface.positions[v]);
    EXPECT_LT(1000.0 * mean_distance(front, {found.positions, {}, adult().level(0).triangles}),
              6.0);
    EXPECT_FALSE(session().report().at("calibrated").get<bool>());
}

TEST(DepthFit, APersonIsNoWall) {
    const Somebody who(52);
    for (const float degrees : {90.0f, 105.0f, 240.0f}) {
        const float yaw = degrees * body::kDegree;
        const FitCamera camera = camera_at(Vec3f(2.4f * std::sin(yaw), 1.0f, 2.4f * std::cos(yaw)));
        auto view = std::make_shared<DepthView>();
        view->camera = camera.intrinsics;
        view->depth = depth_of(camera, &who.surface);
        const std::vector<std::shared_ptr<DepthView>> views{view};
        const ObservedPerson person = observe_person(views, 0);
        ASSERT_EQ(person.observations.size(), 1u) << person.trouble;
        EXPECT_GT(person.observations[0].points.size(), 2000u) << degrees;
    }
}

TEST(DepthFit, AnEmptyRoomIsRefused) {
    session().begin(four_sides());
    show(four_sides(), nullptr);
    EXPECT_ERROR(session().fit({}, &serial_rows), "no person");
}

TEST(DepthFit, PicturesWithoutReadingsAreRefused) {
    session().begin({camera_at(Vec3f(0.0f, 1.0f, 2.4f))});
    imaging::DepthImage nothing;
    nothing.width = kWidth;
    nothing.height = kHeight;
    nothing.metres.assign(kWidth * kHeight, std::nanf(""));
    session().add_instant({nothing});
    EXPECT_ERROR(session().fit({}, &serial_rows), "no reading within");
    nothing.width = 3;
    EXPECT_ERROR(session().add_instant({nothing}), "camera's size");
    nothing.width = kWidth;
    imaging::Image small;
    small.width = small.height = 1;
    small.pixels.assign(4, 0);
    EXPECT_ERROR(session().add_instant({nothing}, {small}), "depth picture's size");
    session().begin({});
    EXPECT_ERROR(session().fit({}, &serial_rows), "nothing was fed");
}

} // namespace
} // namespace toile::scape_fit
