#include "scan/fusion.h"

#include "scan/subject.h"
#include "support/depth_pictures.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::scan {
namespace {

using test::camera_around;
using test::depth_picture;
using test::small_depth_camera;

class Lump {
  public:
    Lump() : mesh_(test::lump()), surface_(mesh_.positions, mesh_.triangles) {}

    [[nodiscard]] DepthView view(const Pose& world_from_camera, float noise_m = 0.0f,
                                 std::uint64_t seed = 1) const {
        const auto camera = small_depth_camera();
        const auto depth = depth_picture(surface_, camera, world_from_camera, noise_m, seed);
        const Subject subject = find_subject({camera, depth, {}}, Vec3f::UnitY());
        EXPECT_EQ(subject.trouble, "");
        return filtered_view({camera, depth, {}}, subject.mask, {}, serial_rows);
    }
    /// Mean and 95 % of the distances of points (first camera's coordinates) from the lump.
    [[nodiscard]] std::pair<double, double> off(const std::vector<Vec3f>& points,
                                                const Pose& first) const {
        std::vector<float> all;
        double mean = 0.0;
        for (const Vec3f& p : points) {
            all.push_back(surface_.nearest(first.cast<float>() * p).distance);
            mean += all.back() / static_cast<double>(points.size());
        }
        std::sort(all.begin(), all.end());
        return {mean, all[all.size() * 95 / 100]};
    }

  private:
    geometry::TriangleMesh mesh_;
    geometry::NearestSurface surface_;
};

const Lump& the_lump() {
    static const Lump lump;
    return lump;
}

constexpr int kViews = 36;

/// A camera that goes round, bobbing; its turns are not even.
Pose way(int k) {
    const double at = 2.0 * std::numbers::pi * (k + 0.2 * std::sin(k)) / kViews;
    Pose out = camera_around(at, 1.0 + 0.02 * std::sin(2.0 * at));
    out.translation().y() += 0.03 * std::sin(3.0 * at);
    return out;
}

FusedSurface fused(const FusionOptions& options, float noise_m, int views = kViews) {
    RigidFusion fusion(options, serial_rows);
    for (int k = 0; k < views; ++k)
        fusion.add(the_lump().view(way(k), noise_m, static_cast<std::uint64_t>(k) + 1));
    return fusion.finish(std::nullopt, [](double) {});
}

double angle_of(const Pose& pose) {
    return Eigen::AngleAxisd(pose.linear()).angle();
}

TEST(Registration, FindsAMotionWithinItsReach) {
    const DepthView first = the_lump().view(camera_around(0.0)),
                    second = the_lump().view(camera_around(0.12));
    Volume volume((camera_around(0.0).inverse() * Vec3d::Zero()).cast<float>(),
                  {0.006f, 0.03f, 0.5f});
    volume.integrate(first, Pose::Identity(), serial_rows);
    const Pose truth = camera_around(0.0).inverse() * camera_around(0.12);
    Registered found;
    for (const float reach : {0.08f, 0.03f}) {
        RegistrationOptions options;
        options.reach_m = reach;
        const SurfaceMap map = raycast(volume, second, 2, reach, found.pose, serial_rows);
        found = register_view(second, map, found.pose, options, serial_rows);
    }
    const Pose error = found.pose * truth.inverse();
    EXPECT_LT(angle_of(error), 0.004);
    EXPECT_LT((found.pose.translation() - truth.translation()).norm(), 0.003);
    EXPECT_GT(found.overlap, 0.7);
}

TEST(Registration, JointlyTheTruthIsAFixedPointAndNearbyPosesComeBackToIt) {
    std::vector<DepthView> views;
    std::vector<Pose> truth, poses;
    Random random(5);
    for (int k = 0; k < 12; ++k) {
        views.push_back(the_lump().view(camera_around(k * std::numbers::pi / 6.0)));
        truth.push_back(camera_around(k * std::numbers::pi / 6.0));
        Pose moved = truth.back();
        if (k > 0) {
            moved.pretranslate(
                Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * 0.004);
            moved.rotate(Eigen::AngleAxisd(random.uniform(-0.01, 0.01), Vec3d::UnitY()));
        }
        poses.push_back(moved);
    }
    const auto pairs = overlapping_pairs(truth, 1.1, 6);
    EXPECT_GE(pairs.size(), 12u); // round the whole turn
    register_jointly(views, pairs, {}, poses, serial_rows);
    for (std::size_t k = 0; k < poses.size(); ++k) {
        EXPECT_LT((poses[k].translation() - truth[k].translation()).norm(), 0.0025) << k;
        EXPECT_LT(angle_of(poses[k].inverse() * truth[k]), 0.0025) << k;
    }
}

TEST(Volume, HoldsTheDistanceToWhatItWasShown) {
    const Pose place = camera_around(0.0);
    Volume volume(Vec3f::Zero(), {0.005f, 0.02f, 0.5f});
    volume.integrate(the_lump().view(place), place, serial_rows);
    const auto mesh = test::lump();
    const geometry::NearestSurface surface(mesh.positions, mesh.triangles);
    int count = 0;
    for (float x = -0.06f; x < 0.06f; x += 0.011f)
        for (float y = -0.06f; y < 0.06f; y += 0.011f) {
            const auto hit = surface.first_hit(Vec3f(x, y, 1.0f), -Vec3f::UnitZ());
            ASSERT_TRUE(hit);
            for (const float off : {-0.004f, 0.0f, 0.006f}) {
                const Vec3f p(x, y, 1.0f - hit->distance + off);
                float distance = 0.0f;
                Vec3f slope;
                if (!volume.sample(p, distance, slope)) continue;
                EXPECT_NEAR(distance, surface.nearest(p).signed_distance, 0.002f);
                EXPECT_GT(slope.z(), 0.3f);
                ++count;
            }
        }
    EXPECT_GT(count, 200);
}

TEST(Fusion, AMovingCameraGivesTheLumpAsItIs) {
    const FusedSurface scan = fused({}, 0.0f);
    EXPECT_EQ(scan.report.lost_frames, 0u);
    EXPECT_TRUE(scan.report.loop_closed);
    EXPECT_LT(scan.report.loop_error_m, 0.002);
    const auto [mean, p95] = the_lump().off(scan.mesh.positions, way(0));
    EXPECT_LT(mean, 0.0012);
    EXPECT_LT(p95, 0.005); // seams between the balls, top and bottom
    const auto topology = geometry::check_topology(scan.mesh.positions, scan.mesh.triangles);
    EXPECT_TRUE(topology.closed()) << topology.text();
    EXPECT_EQ(topology.components, 1u);
    EXPECT_GT(geometry::volume(scan.mesh), 0.0);
    for (std::size_t k = 0; k < scan.poses.size(); ++k)
        EXPECT_LT(
            (way(0) * scan.poses[k] * Vec3d(0, 0, -1) - way(static_cast<int>(k)) * Vec3d(0, 0, -1))
                .norm(),
            0.004)
            << k;
}

TEST(Fusion, ClosingTheLoopHelpsWithNoise) {
    FusionOptions open;
    open.close_loop = open.refine_jointly = false;
    const FusedSurface chain = fused(open, 0.006f), closed = fused({}, 0.006f);
    EXPECT_FALSE(chain.report.loop_closed);
    EXPECT_LT(closed.report.loop_error_m, 0.002);
    const double without = the_lump().off(chain.mesh.positions, way(0)).first,
                 with = the_lump().off(closed.mesh.positions, way(0)).first;
    EXPECT_LT(with, without + 0.0001);
    EXPECT_LT(with, 0.0016);
}

TEST(Fusion, HalfATurnIsClosedByAGuess) {
    const FusedSurface scan = fused({}, 0.0f, kViews / 3);
    EXPECT_FALSE(scan.report.loop_closed);
    EXPECT_GT(scan.report.guessed_share, 0.1);
    const auto topology = geometry::check_topology(scan.mesh.positions, scan.mesh.triangles);
    EXPECT_TRUE(topology.closed()) << topology.text();
}

TEST(Fusion, AViewAfterAJumpIsLostAndTheRestGoesOn) {
    RigidFusion fusion({}, serial_rows);
    fusion.add(the_lump().view(camera_around(0.0)));
    fusion.add(the_lump().view(camera_around(0.1)));
    Pose jumped = camera_around(0.15);
    jumped.translation().x() += 0.25;
    fusion.add(the_lump().view(jumped));
    fusion.add(the_lump().view(camera_around(0.2)));
    const FusedSurface scan = fusion.finish(std::nullopt, [](double) {});
    EXPECT_EQ(scan.report.lost_frames, 1u);
    EXPECT_EQ(scan.frames, (std::vector<std::uint32_t>{0, 1, 3}));
}

TEST(Fusion, AfterAJumpWhatIsLikelyHelpsIfItCouldBe) {
    Pose jumped = camera_around(0.2);
    jumped.translation().x() += 0.3;
    const Pose told = camera_around(0.0).inverse() * jumped;
    const auto lost = [&](const std::optional<Pose>& likely) {
        RigidFusion fusion({}, serial_rows);
        fusion.add(the_lump().view(camera_around(0.0)));
        fusion.add(the_lump().view(camera_around(0.1)));
        fusion.add(the_lump().view(jumped), likely);
        const FusedSurface out = fusion.finish(std::nullopt, [](double) {});
        if (out.poses.size() == 3) {
            EXPECT_LT((out.poses[2].translation() - told.translation()).norm(), 0.01);
            EXPECT_LT(angle_of(told.inverse() * out.poses[2]), 0.02);
        }
        return out.report.lost_frames;
    };
    EXPECT_EQ(lost(std::nullopt), 1u);
    Pose near = told;
    near.translation().x() += 0.02;
    EXPECT_EQ(lost(near), 0u);
    EXPECT_EQ(lost(camera_around(0.0).inverse() * camera_around(std::numbers::pi)), 1u)
        << "nothing turns half round from one view to the next";
}

TEST(Fusion, OneViewIsNotEnough) {
    RigidFusion none({}, serial_rows), one({}, serial_rows);
    EXPECT_THROW((void)none.finish(std::nullopt, [](double) {}), std::runtime_error);
    one.add(the_lump().view(camera_around(0.0)));
    EXPECT_THROW((void)one.finish(std::nullopt, [](double) {}), std::runtime_error);
}

TEST(Fusion, ColoursAreThoseSeen) {
    RigidFusion fusion({}, serial_rows);
    for (int k = 0; k < 6; ++k) {
        DepthView view = the_lump().view(camera_around(0.15 * k));
        view.colors.assign(view.depth.size(), Rgba8{180, 60, 20, 255});
        fusion.add(std::move(view));
    }
    const FusedSurface scan = fusion.finish(std::nullopt, [](double) {});
    ASSERT_EQ(scan.colors.size(), scan.mesh.positions.size());
    for (const Rgba8& color : scan.colors)
        EXPECT_EQ(color, (Rgba8{180, 60, 20, 255}));
}

} // namespace
} // namespace toile::scan
