// Cameras that do not say where they stand, placed from the person.
#include "room_cameras.h"
#include "support/throws.h"

#include <cmath>

namespace toile::scape_fit {
namespace {

using Instants = std::vector<std::vector<imaging::DepthImage>>;

/// Around the middle of the room, 2.4 m away, not of one height nor level.
FitCamera around(float degrees) {
    const float yaw = degrees * body::kDegree;
    return camera_at(Vec3f(2.4f * std::sin(yaw), 1.1f + 0.1f * std::sin(2.0f * yaw + 0.4f),
                           2.4f * std::cos(yaw)),
                     0.06f + 0.03f * std::cos(3.0f * yaw));
}

FitCamera lost(FitCamera camera) {
    camera.world_from_camera.reset();
    return camera;
}

std::vector<FitCamera> all_lost(std::vector<FitCamera> cameras) {
    for (FitCamera& camera : cameras)
        camera.world_from_camera.reset();
    return cameras;
}

std::vector<imaging::DepthImage> pictures(const std::vector<FitCamera>& cameras,
                                          const geometry::TriangleMesh& person) {
    std::vector<imaging::DepthImage> out;
    for (const FitCamera& camera : cameras)
        out.push_back(depth_of(camera, &person));
    return out;
}

/// Somebody with both arms held alike, turned about the vertical.
geometry::TriangleMesh standing(const Somebody& who, float lift, float bend, float turn) {
    const body::Skeleton skeleton = adult().skeleton(who.shape.coefficients);
    body::Pose pose;
    const auto set = [&](body::Joint joint, const Vec3f& share) {
        pose.rotations[static_cast<std::size_t>(joint)] =
            body::from_rotation_vector(body::limited_rotation(skeleton, joint, share));
    };
    for (const body::Joint arm : {body::Joint::left_upper_arm, body::Joint::right_upper_arm})
        set(arm, Vec3f(0.0f, 0.0f, lift));
    for (const body::Joint elbow : {body::Joint::left_lower_arm, body::Joint::right_lower_arm})
        set(elbow, Vec3f(0.0f, bend, 0.0f));
    pose.rotations[0] = body::about(Vec3f::UnitY(), turn);
    PosedLevel posed;
    pose_level(adult(), adult().level(0), who.shape, pose, posed);
    float low = 1e9f;
    for (const Vec3f& p : posed.positions)
        low = std::min(low, p.y());
    for (Vec3f& p : posed.positions)
        p.y() -= low;
    return {posed.positions, {}, adult().level(0).triangles};
}

Placement placed(const std::vector<FitCamera>& told, const Instants& instants) {
    static Fitter fitter(adult());
    return place_cameras(adult(), fitter, told, instants, {}, &serial_rows);
}

double degrees_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return Eigen::AngleAxisd(a.transpose() * b).angle() / static_cast<double>(body::kDegree);
}

/// Places of cameras as the first sees them, against the truth.
void expect_near(const std::vector<Eigen::Isometry3d>& found, const std::vector<FitCamera>& truth,
                 double metres, double degrees) {
    ASSERT_EQ(found.size(), truth.size());
    for (std::size_t c = 1; c < found.size(); ++c) {
        const Eigen::Isometry3d is = found[0].inverse() * found[c];
        const Eigen::Isometry3d should =
            truth[0].world_from_camera->inverse() * *truth[c].world_from_camera;
        EXPECT_LT((is.translation() - should.translation()).norm(), metres) << "camera " << c;
        EXPECT_LT(degrees_between(is.linear(), should.linear()), degrees) << "camera " << c;
    }
}

std::vector<Eigen::Isometry3d> places_of(const Placement& placement) {
    EXPECT_EQ(placement.trouble, "");
    std::vector<Eigen::Isometry3d> out;
    for (const PlacedCamera& camera : placement.cameras)
        out.push_back(camera.world_from_camera);
    return out;
}

std::vector<Eigen::Isometry3d> places_of(const nlohmann::ordered_json& report) {
    std::vector<Eigen::Isometry3d> out;
    for (const auto& camera : report.at("found_cameras")) {
        const auto numbers = camera.at("world_from_camera").get<std::vector<double>>();
        EXPECT_EQ(numbers.size(), 16u);
        out.emplace_back(Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(numbers.data())));
    }
    return out;
}

FitSession& session() {
    static FitSession one(adult());
    return one;
}

void fit(const std::vector<FitCamera>& told, const std::vector<imaging::DepthImage>& depths) {
    session().begin(told);
    session().add_instant(depths);
    session().fit({}, &serial_rows);
}

TEST(CameraPlacement, GirthsAreThoseOfCamerasThatKnow) {
    const Somebody who;
    const std::vector<FitCamera> cameras{around(0.0f), around(90.0f)};
    const auto depths = pictures(cameras, who.surface);
    fit(cameras, depths);
    EXPECT_FALSE(session().report().contains("found_cameras"));
    const body::Measurements given = session().measurements();
    fit(all_lost(cameras), depths);
    EXPECT_FALSE(session().report().at("calibrated").get<bool>());
    const auto found = places_of(session().report());
    expect_near(found, cameras, 0.025, 1.0);
    // The first camera's world: upright, the floor at y = 0.
    EXPECT_NEAR(found[0].translation().y(), cameras[0].world_from_camera->translation().y(), 0.01);
    EXPECT_NEAR(found[0].linear().col(1).y(), cameras[0].world_from_camera->linear()(1, 1), 0.002);
    ASSERT_EQ(given.size(), session().measurements().size());
    for (std::size_t i = 0; i < given.size(); ++i) {
        const std::string_view name = given[i].name;
        if (name == "bust_girth" || name == "waist_girth" || name == "hip_girth" ||
            name == "stature") {
            EXPECT_NEAR(session().measurements()[i].value_m, given[i].value_m, 0.012) << name;
        }
    }
}

TEST(CameraPlacement, FrontAndBackOfOneWhoStandsAlikeOnBothSides) {
    const geometry::TriangleMesh person = standing(Somebody(11), -0.8f, 0.0f, 0.0f);
    const std::vector<FitCamera> cameras{around(0.0f), around(180.0f)};
    expect_near(places_of(placed(all_lost(cameras), {pictures(cameras, person)})), cameras, 0.03,
                1.0);
}

TEST(CameraPlacement, FourSidesFromTheBackOn) {
    const Somebody who(6);
    const std::vector<FitCamera> cameras{around(180.0f), around(270.0f), around(0.0f),
                                         around(90.0f)};
    expect_near(places_of(placed(all_lost(cameras), {pictures(cameras, who.surface)})), cameras,
                0.025, 1.0);
}

TEST(CameraPlacement, SomeoneWhoMovesWithInstantsThatOneCameraMisses) {
    const Somebody who(12);
    const std::vector<FitCamera> cameras{around(20.0f), around(120.0f)};
    Instants instants;
    instants.push_back(pictures(cameras, standing(who, -0.8f, 0.0f, 0.0f)));
    instants.push_back(pictures(cameras, standing(who, 0.3f, 0.3f, -0.6f)));
    instants.push_back(instants.back());
    instants.back()[1] = depth_of(cameras[1], nullptr);
    expect_near(places_of(placed(all_lost(cameras), instants)), cameras, 0.025, 1.0);
}

TEST(CameraPlacement, OneThatSeesNoFloor) {
    const Somebody who;
    const std::vector<FitCamera> cameras{around(0.0f), around(70.0f)};
    auto depths = pictures(cameras, who.surface);
    depths[1] = depth_of(cameras[1], &who.surface, true);
    expect_near(places_of(placed(all_lost(cameras), {depths})), cameras, 0.03, 1.0);
}

TEST(CameraPlacement, TheLostOneJoinsThoseThatKnow) {
    const Somebody who;
    const std::vector<FitCamera> cameras{around(90.0f), around(0.0f), around(180.0f)};
    fit({lost(cameras[0]), cameras[1], cameras[2]}, pictures(cameras, who.surface));
    const auto& report = session().report();
    EXPECT_FALSE(report.at("calibrated").get<bool>());
    EXPECT_FALSE(report.at("found_cameras").at(0).at("told").get<bool>());
    EXPECT_TRUE(report.at("found_cameras").at(1).at("told").get<bool>());
    EXPECT_GT(report.at("found_cameras").at(0).at("believed_within_m").get<double>(),
              report.at("found_cameras").at(1).at("believed_within_m").get<double>());
    const auto found = places_of(report);
    for (std::size_t c = 0; c < found.size(); ++c) {
        const Eigen::Isometry3d& truth = *cameras[c].world_from_camera;
        EXPECT_LT((found[c].translation() - truth.translation()).norm(), 0.02) << c;
        EXPECT_LT(degrees_between(found[c].linear(), truth.linear()), 0.7) << c;
    }
}

TEST(CameraPlacement, TwoPeopleAreRefused) {
    const std::vector<FitCamera> cameras{around(0.0f), around(90.0f)};
    const auto a = standing(Somebody(12), -0.8f, 0.0f, 0.0f);
    const auto b = standing(Somebody(32), 0.3f, 0.3f, -0.6f);
    session().begin(all_lost(cameras));
    session().add_instant({depth_of(cameras[0], &a), depth_of(cameras[1], &b)});
    EXPECT_ERROR(session().fit({}, &serial_rows), "the cameras cannot be placed from the person");
    EXPECT_FALSE(session().fitted());
}

TEST(CameraPlacement, NobodyIsRefusedNamingTheCamera) {
    const Somebody who;
    const std::vector<FitCamera> cameras{around(0.0f), around(90.0f)};
    session().begin(all_lost(cameras));
    session().add_instant({depth_of(cameras[0], &who.surface), depth_of(cameras[1], nullptr)});
    EXPECT_ERROR(session().fit({}, &serial_rows), "camera 2, instant 0: no person");
}

} // namespace
} // namespace toile::scape_fit
