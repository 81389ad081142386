// Known scenes give known depths; each error has the size that its formula says.
#include "imaging/depth_noise.h"
#include "simulated_sensor/tests/stages.h"

#include <cmath>
#include <numbers>

namespace toile::simulated_sensor {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Measured minus true depth over the picture of a tilted plane, in units of sigma_z.
std::vector<double> scaled_errors(const DepthCamera& camera, double depth, double tilt) {
    std::vector<double> out;
    for (std::size_t i = 0; i < camera.depth().metres.size(); ++i) {
        const auto measured = static_cast<double>(camera.depth().metres[i]);
        if (std::isnan(measured)) continue;
        const double z = plane_depth(camera.directions()[i], depth, tilt);
        const auto angle = std::acos(static_cast<double>(camera.hits().cosine[i]));
        out.push_back((measured - z) / imaging::axial_sigma(z, angle));
    }
    return out;
}

TEST(DepthCamera, FieldsOfViewAreThoseOfTheModels) {
    const auto v1 = camera_of(CameraModel::kinect_v1).intrinsics();
    EXPECT_EQ(v1.width, 640);
    EXPECT_EQ(v1.height, 480);
    EXPECT_NEAR(v1.field_of_view().x(), 57.0 * kDegree, 1e-9);
    EXPECT_NEAR(v1.field_of_view().y(), 43.0 * kDegree, 1e-9);
    CameraSettings settings = camera_of(CameraModel::kinect_v2);
    settings.upright = true;
    const auto v2 = settings.intrinsics();
    EXPECT_EQ(v2.width, 424);
    EXPECT_EQ(v2.height, 512);
    EXPECT_NEAR(v2.field_of_view().x(), 60.0 * kDegree, 1e-9);
    EXPECT_NEAR(v2.field_of_view().y(), 70.6 * kDegree, 1e-9);
}

TEST(DepthCamera, ATiltedPlaneIsExactWithoutNoise) {
    for (const double tilt : {0.0, 20.0 * kDegree, -50.0 * kDegree}) {
        Stage stage;
        add(stage, tilted_plane(2.0f, static_cast<float>(tilt)));
        stage.commit();
        CameraSettings settings = bare_camera();
        settings.farthest_m = 100.0;
        DepthCamera camera(settings, 1, 0);
        see(camera, stage);
        std::size_t seen = 0;
        for (std::size_t i = 0; i < camera.depth().metres.size(); ++i) {
            const double z = plane_depth(camera.directions()[i], 2.0, tilt);
            if (!(z > settings.nearest_m && z < 20.0)) continue;
            ASSERT_NEAR(static_cast<double>(camera.depth().metres[i]), z, 1e-5 * z) << i;
            ++seen;
        }
        EXPECT_GT(seen, 150000u);
    }
}

TEST(DepthCamera, ASphereHasItsSilhouetteAndItsPointsLieOnIt) {
    constexpr double kRadius = 0.3;
    Stage stage;
    geometry::TriangleMesh sphere = test::sphere(static_cast<float>(kRadius), 6);
    for (Vec3f& p : sphere.positions)
        p += Vec3f(0.1f, -0.05f, -2.0f);
    add(stage, sphere);
    stage.commit();
    DepthCamera camera(bare_camera(), 1, 0);
    see(camera, stage);
    const imaging::DepthUnprojector unprojector(camera.intrinsics());
    std::vector<Vec3f> points(camera.depth().metres.size());
    unprojector.points(camera.depth().metres, points);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d ray = camera.directions()[i].cast<double>().normalized();
        const Vec3d centre(0.1, -0.05, -2.0);
        const double miss = (centre - centre.dot(ray) * ray).norm();
        const bool hit = !std::isnan(camera.depth().metres[i]);
        if (miss < kRadius - 0.001) {
            EXPECT_TRUE(hit) << miss;
        }
        if (miss > kRadius) {
            EXPECT_FALSE(hit) << miss;
        }
        if (!hit) continue;
        ++seen;
        EXPECT_NEAR((points[i].cast<double>() - centre).norm(), kRadius, 3e-4);
    }
    EXPECT_GT(seen, 20000u);
}

TEST(DepthCamera, AxialNoiseFollowsNguyen) {
    for (const double depth : {0.8, 1.5, 2.5, 4.0})
        for (const double tilt : {0.0, 35.0 * kDegree, 70.0 * kDegree}) {
            Stage stage;
            add(stage, tilted_plane(static_cast<float>(depth), static_cast<float>(tilt)));
            stage.commit();
            CameraSettings settings = bare_camera();
            settings.noise.axial = 1.0;
            settings.nearest_m = 0.1;
            settings.farthest_m = 100.0;
            DepthCamera camera(settings, 5, 0);
            see(camera, stage, 3);
            const Spread spread = spread_of(scaled_errors(camera, depth, tilt));
            ASSERT_GT(spread.count, 50000u);
            const double n = static_cast<double>(spread.count);
            EXPECT_NEAR(spread.mean, 0.0, 4.0 / std::sqrt(n)) << depth << " m, " << tilt;
            EXPECT_NEAR(spread.deviation, 1.0, 4.0 / std::sqrt(2.0 * n)) << depth << " m, " << tilt;
        }
    // The formula itself, against figures worked out by hand.
    EXPECT_NEAR(imaging::axial_sigma(2.4, 0.0), 0.0012 + 0.0019 * 4.0, 1e-12);
    EXPECT_NEAR(imaging::axial_sigma(1.0, 75.0 * kDegree), 0.001884 + 0.0001 * 25.0, 1e-9);
    EXPECT_NEAR(imaging::lateral_sigma(45.0 * kDegree), 0.835, 1e-12);
}

TEST(DepthCamera, CorrelatedNoiseKeepsItsSizeAndGoesTogether) {
    Stage stage;
    add(stage, tilted_plane(2.0f, 0.0f));
    stage.commit();
    CameraSettings settings = bare_camera();
    settings.noise.axial = 1.0;
    settings.noise.correlated = true;
    DepthCamera camera(settings, 5, 0);
    see(camera, stage, 3);
    const auto errors = scaled_errors(camera, 2.0, 0.0);
    ASSERT_EQ(errors.size(), 640u * 480u);
    EXPECT_NEAR(spread_of(errors).deviation, 1.0, 0.02);
    // Of the binomial kernel with itself: 56/70 beside, 28/70 two away, nothing five away.
    for (const auto& [lag, expected] : {std::pair{1, 0.8}, {2, 0.4}, {6, 0.0}})
        for (const int step : {1, 640}) {
            std::vector<double> products;
            for (int y = 0; y + 6 < 480; ++y)
                for (int x = 0; x + 6 < 640; ++x) {
                    const auto i = static_cast<std::size_t>(640 * y + x);
                    products.push_back(errors[i] *
                                       errors[i + static_cast<std::size_t>(lag * step)]);
                }
            EXPECT_NEAR(spread_of(products).mean, expected, 0.03) << lag << " x " << step;
        }
}

TEST(DepthCamera, FramesAndCamerasDrawDifferentNoise) {
    Stage stage;
    add(stage, tilted_plane(2.0f, 0.0f));
    stage.commit();
    CameraSettings settings = bare_camera();
    settings.noise.axial = 1.0;
    DepthCamera first(settings, 5, 0);
    DepthCamera second(settings, 5, 1);
    see(first, stage, 0);
    see(second, stage, 0);
    const auto a = scaled_errors(first, 2.0, 0.0);
    const auto b = scaled_errors(second, 2.0, 0.0);
    see(first, stage, 1);
    const auto c = scaled_errors(first, 2.0, 0.0);
    std::vector<double> ab;
    std::vector<double> ac;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab.push_back(a[i] * b[i]);
        ac.push_back(a[i] * c[i]);
    }
    EXPECT_NEAR(spread_of(ab).mean, 0.0, 4.0 / std::sqrt(static_cast<double>(a.size())));
    EXPECT_NEAR(spread_of(ac).mean, 0.0, 4.0 / std::sqrt(static_cast<double>(a.size())));
}

// A board with a straight edge: the share of frames in which a pixel still shows the board is the
// normal distribution of sigma_L at its distance from the edge.
TEST(DepthCamera, LateralNoiseMovesSilhouettesByItsSigma) {
    Stage stage;
    add(stage, test::box(Vec3f(-5.0f, -5.0f, -1.6f), Vec3f(0.001f, 5.0f, -1.5f)));
    stage.commit();
    CameraSettings settings = bare_camera();
    settings.noise.lateral = 1.0;
    DepthCamera camera(settings, 9, 0);
    const double edge = imaging::project(camera.intrinsics(), Vec3d(0.001, 0.0, -1.5))->x();
    const int first = static_cast<int>(std::lround(edge)) - 2;
    std::array<int, 5> shown{};
    constexpr int kFrames = 12;
    camera.look(stage, &serial_rows);
    for (int frame = 0; frame < kFrames; ++frame) {
        camera.measure(stage, static_cast<std::uint32_t>(frame), &serial_rows, false);
        for (int y = 0; y < 480; ++y)
            for (int k = 0; k < 5; ++k)
                shown[static_cast<std::size_t>(k)] +=
                    std::isnan(camera.depth().metres[static_cast<std::size_t>(640 * y + first + k)])
                        ? 0
                        : 1;
    }
    for (int k = 0; k < 5; ++k) {
        const double share = shown[static_cast<std::size_t>(k)] / (480.0 * kFrames);
        const double outside = first + k - edge;
        const double expected =
            0.5 * std::erfc(outside / imaging::lateral_sigma(0.0) / std::numbers::sqrt2);
        EXPECT_NEAR(share, expected, 0.04) << outside << " pixels";
    }
}

TEST(DepthCamera, LateralNoiseLeavesSurfacesWithoutEdgesAlone) {
    Stage stage;
    add(stage, tilted_plane(2.0f, 0.9f));
    stage.commit();
    CameraSettings settings = bare_camera();
    settings.noise.lateral = 1.0;
    settings.noise.ragged = true;
    settings.farthest_m = 100.0;
    DepthCamera camera(settings, 9, 0);
    see(camera, stage);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < camera.depth().metres.size(); ++i) {
        const double z = plane_depth(camera.directions()[i], 2.0, static_cast<double>(0.9f));
        if (!(z > 0.5 && camera.hits().cosine[i] > 0.25f)) continue; // not grazing either
        ASSERT_NEAR(static_cast<double>(camera.depth().metres[i]), z, 1e-4);
        ++seen;
    }
    EXPECT_GT(seen, 100000u);
}

TEST(DepthCamera, QuantisationRoundsToTheNearestStepAndHasNoBias) {
    const double focal = camera_of(CameraModel::kinect_v1).baseline_focal();
    const auto step = [&](double z) { return z * z / (imaging::kDisparitySteps * focal); };
    EXPECT_NEAR(step(0.9), 0.0023, 0.0002);
    EXPECT_NEAR(step(2.6), 0.0191, 0.002);
    for (const double from : {0.8, 1.5, 2.4}) {
        std::vector<double> errors;
        for (double z = from; z < from + 0.4; z += 1e-5) {
            const double q = imaging::quantise_disparity(z, focal);
            ASSERT_LE(std::abs(q - z), 0.51 * step(z + 0.01));
            const double disparity = imaging::kDisparitySteps * focal / q;
            ASSERT_NEAR(disparity, std::round(disparity), 1e-9);
            errors.push_back(q - z);
        }
        EXPECT_NEAR(spread_of(errors).mean, 0.0, 0.02 * step(from + 0.2)) << from;
    }
}

/// A box of 40 cm at 1.5 m before a wall at 3 m.
void add_box_before_wall(Stage& stage) {
    add(stage, test::box(Vec3f(-0.2f, -0.2f, -1.6f), Vec3f(0.2f, 0.2f, -1.5f)));
    add(stage, tilted_plane(3.0f, 0.0f));
    stage.commit();
}

TEST(DepthCamera, TheShadowFallsToTheLeftAndIsAsWideAsTheDisparity) {
    Stage stage;
    add_box_before_wall(stage);
    CameraSettings settings = bare_camera();
    settings.noise.shadow = true;
    DepthCamera camera(settings, 1, 0);
    see(camera, stage);
    const auto& in = camera.intrinsics();
    const double left = imaging::project(in, Vec3d(-0.2, 0, -1.5))->x();
    const double width = settings.baseline_focal() * (1.0 / 1.5 - 1.0 / 3.0);
    ASSERT_GT(width, 10.0);
    for (int y = 230; y < 250; ++y) {
        int lost = 0;
        for (int x = 0; x < in.width; ++x) {
            if (!std::isnan(camera.depth().metres[static_cast<std::size_t>(in.width * y + x)]))
                continue;
            ++lost;
            EXPECT_LT(x, left);
            EXPECT_GT(x, left - width - 2.0);
        }
        EXPECT_NEAR(lost, width, 1.6);
    }
}

TEST(DepthCamera, UprightTheShadowFallsBelow) {
    Stage stage;
    add_box_before_wall(stage);
    CameraSettings settings = bare_camera();
    settings.upright = true;
    settings.noise.shadow = true;
    DepthCamera camera(settings, 1, 0);
    see(camera, stage);
    const auto& in = camera.intrinsics();
    const double bottom = imaging::project(in, Vec3d(0, -0.2, -1.5))->y();
    const double width = settings.baseline_focal() * (1.0 / 1.5 - 1.0 / 3.0);
    int lost = 0;
    for (int y = 0; y < in.height; ++y) {
        const auto i = static_cast<std::size_t>(in.width * y + in.width / 2);
        if (!std::isnan(camera.depth().metres[i])) continue;
        ++lost;
        EXPECT_GT(y, bottom);
        EXPECT_LT(y, bottom + width + 2.0);
    }
    EXPECT_NEAR(lost, width, 1.6);
}

TEST(DepthCamera, EdgesAreRaggedAndOnlyEdges) {
    Stage stage;
    add_box_before_wall(stage);
    CameraSettings settings = bare_camera();
    settings.noise.ragged = true;
    DepthCamera camera(settings, 1, 0);
    see(camera, stage);
    const auto& in = camera.intrinsics();
    const double left = imaging::project(in, Vec3d(-0.2, 0, -1.5))->x();
    const double right = imaging::project(in, Vec3d(0.2, 0, -1.5))->x();
    int lost = 0;
    for (int y = 200; y < 280; ++y)
        for (int x = 0; x < in.width; ++x) {
            if (!std::isnan(camera.depth().metres[static_cast<std::size_t>(in.width * y + x)]))
                continue;
            ++lost;
            EXPECT_LT(std::min(std::abs(x - left), std::abs(x - right)), 1.5) << x;
        }
    // Two pixels beside each of two edges, 35 % of them.
    EXPECT_NEAR(lost / (80.0 * 4.0), 0.35, 0.12);
}

TEST(DepthCamera, HairGivesFewerReadingsThanSkin) {
    for (const auto& [grain, least, most] :
         {std::tuple{Grain::skin, 1.0, 1.0}, {Grain::hair, 0.6, 0.8}}) {
        Stage stage;
        add(stage, tilted_plane(2.0f, 0.0f), grain);
        stage.commit();
        CameraSettings settings = bare_camera();
        settings.noise.ragged = true;
        DepthCamera camera(settings, 1, 0);
        see(camera, stage);
        double seen = 0.0;
        for (const float z : camera.depth().metres)
            seen += std::isnan(z) ? 0.0 : 1.0;
        seen /= static_cast<double>(camera.depth().metres.size());
        EXPECT_GE(seen, least);
        EXPECT_LE(seen, most);
    }
}

TEST(DepthCamera, SystematicErrorsAreDrawnOnceAndWithinTheirBounds) {
    NoiseSettings noise = full_noise(CameraModel::kinect_v1);
    std::vector<double> scales;
    std::vector<double> shifts;
    std::vector<double> angles;
    for (std::uint32_t camera = 0; camera < 400; ++camera) {
        const SystematicErrors errors = draw_errors(noise, 3, camera);
        EXPECT_LE(std::abs(errors.depth_scale - 1.0), 0.005);
        scales.push_back(errors.depth_scale);
        shifts.push_back(errors.pose_error.translation().x());
        angles.push_back(Eigen::AngleAxisd(errors.pose_error.linear()).angle());
    }
    EXPECT_NEAR(spread_of(scales).mean, 1.0, 0.0006);
    EXPECT_NEAR(spread_of(scales).deviation, 0.005 / std::sqrt(3.0), 0.0004);
    EXPECT_NEAR(spread_of(shifts).deviation, 0.005, 0.0007);
    EXPECT_NEAR(spread_of(angles).mean, 0.2 * kDegree * std::sqrt(2.0 / std::numbers::pi),
                0.02 * kDegree);
    noise = usual_noise(CameraModel::kinect_v1);
    const SystematicErrors none = draw_errors(noise, 3, 0);
    EXPECT_EQ(none.depth_scale, 1.0);
    EXPECT_TRUE(none.pose_error.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(DepthCamera, DepthScaleStretchesEveryDepth) {
    Stage stage;
    add(stage, tilted_plane(2.0f, 0.0f));
    stage.commit();
    CameraSettings settings = bare_camera();
    settings.noise.depth_scale = 0.05;
    DepthCamera camera(settings, 11, 2);
    see(camera, stage);
    ASSERT_NE(camera.errors().depth_scale, 1.0);
    for (const float z : camera.depth().metres)
        ASSERT_NEAR(static_cast<double>(z), 2.0 * camera.errors().depth_scale, 1e-5);
}

/// Ranges in falling order: nothing may depend on which came first.
void backwards(std::uint32_t count, std::uint32_t grain,
               const std::function<void(std::uint32_t, std::uint32_t)>& body) {
    for (std::uint32_t k = (count + grain - 1) / grain; k-- > 0;)
        body(k * grain, std::min(count, (k + 1) * grain));
}

TEST(DepthCamera, BytesDoNotDependOnTheOrderOfRows) {
    Stage stage;
    add_box_before_wall(stage);
    CameraSettings settings = camera_of(CameraModel::kinect_v1);
    settings.noise = full_noise(CameraModel::kinect_v1);
    DepthCamera one(settings, 4, 1);
    DepthCamera other(settings, 4, 1);
    see(other, stage, 6); // an earlier frame leaves nothing behind
    see(one, stage, 7);
    see(other, stage, 7, &backwards);
    for (std::size_t i = 0; i < one.depth().metres.size(); ++i) {
        const float a = one.depth().metres[i];
        const float b = other.depth().metres[i];
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << i;
    }
}

TEST(PixelRandom, NumbersAreNormalAndUncorrelated) {
    const PixelRandom random(1, 0, 0);
    std::vector<double> values;
    std::vector<double> beside;
    std::vector<double> fourth;
    for (int y = 0; y < 400; ++y)
        for (int x = 0; x < 400; ++x) {
            const auto v = static_cast<double>(random.normal(Draw::depth, x, y));
            values.push_back(v);
            beside.push_back(v * static_cast<double>(random.normal(Draw::depth, x + 1, y)));
            fourth.push_back(v * v * v * v);
        }
    EXPECT_NEAR(spread_of(values).mean, 0.0, 0.01);
    EXPECT_NEAR(spread_of(values).deviation, 1.0, 0.01);
    EXPECT_NEAR(spread_of(beside).mean, 0.0, 0.01);
    EXPECT_NEAR(spread_of(fourth).mean, 3.0, 0.1); // kurtosis of a normal
    EXPECT_GT(*std::max_element(values.begin(), values.end()), 3.9);
}

} // namespace
} // namespace toile::simulated_sensor
