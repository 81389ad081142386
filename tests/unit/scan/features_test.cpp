#include "scan/features.h"

#include "core/random.h"
#include "scan/global_registration.h"
#include "scan/rig_motion.h"
#include "scan/voxel_grid.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::scan {
namespace {

constexpr double kMiddle = 99.5;

/// Soft spots here and there, turned about the middle and scaled.
Grey spots(double turn, double scale) {
    Random random(7);
    struct Spot {
        double x, y, sigma, strength;
    };
    std::vector<Spot> all;
    for (int k = 0; k < 140; ++k)
        all.push_back({random.uniform(-130.0, 130.0), random.uniform(-130.0, 130.0),
                       random.uniform(2.0, 5.0), random.uniform(-0.35, 0.35)});
    Grey out{200, 200, {}};
    const double c = std::cos(turn), s = std::sin(turn);
    for (int v = 0; v < 200; ++v)
        for (int u = 0; u < 200; ++u) {
            const double x = (c * (u - kMiddle) + s * (v - kMiddle)) / scale,
                         y = (-s * (u - kMiddle) + c * (v - kMiddle)) / scale;
            double value = 0.5;
            for (const Spot& spot : all)
                value += spot.strength *
                         std::exp(-0.5 * (std::pow(x - spot.x, 2) + std::pow(y - spot.y, 2)) /
                                  (spot.sigma * spot.sigma));
            out.values.push_back(static_cast<float>(value));
        }
    return out;
}

/// Share of the matches that lie where the turn and the scale take them, and their count.
std::pair<double, std::size_t> right(double turn, double scale, Descriptor descriptor) {
    const auto a = find_features(spots(0.0, 1.0), {}, descriptor, {});
    const auto b = find_features(spots(turn, scale), {}, descriptor, {});
    const auto matches = match(a, b, descriptor, 0.85);
    const double c = std::cos(turn), s = std::sin(turn);
    double count = 0.0;
    for (const Match& m : matches) {
        const double x = a[m.a].x - kMiddle, y = a[m.a].y - kMiddle;
        const double u = scale * (c * x - s * y) + kMiddle, v = scale * (s * x + c * y) + kMiddle;
        count += std::hypot(u - b[m.b].x, v - b[m.b].y) < 2.5 ? 1.0 : 0.0;
    }
    return {count / static_cast<double>(std::max<std::size_t>(1, matches.size())), matches.size()};
}

TEST(Features, BothDescriptionsFollowTurnsAndScales) {
    for (const double turn : {0.0, 0.6, 1.9, -2.7})
        for (const double scale : {0.8, 1.0, 1.3}) {
            const auto [full, full_count] = right(turn, scale, Descriptor::full);
            EXPECT_GT(full, 0.9) << turn << " " << scale;
            EXPECT_GT(full_count, 25u) << turn << " " << scale;
            const auto [simple, simple_count] = right(turn, scale, Descriptor::simple);
            EXPECT_GT(simple, 0.6) << turn << " " << scale;
            EXPECT_GT(simple_count, 15u) << turn << " " << scale;
        }
}

TEST(Features, DescriptionsHaveUnitLengthAndDoNotSeeBrightness) {
    const Grey picture = spots(0.3, 1.0);
    Grey dim = picture;
    for (float& value : dim.values)
        value = 0.1f + 0.7f * value;
    FeatureOptions options, lower;
    lower.contrast = 0.7 * options.contrast;
    for (const auto descriptor : {Descriptor::full, Descriptor::simple}) {
        const auto a = find_features(picture, {}, descriptor, options);
        const auto b = find_features(dim, {}, descriptor, lower);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            double length = 0.0, off = 0.0;
            for (std::size_t k = 0; k < 128; ++k) {
                length += a[i].full[k] * a[i].full[k];
                off += std::abs(a[i].full[k] - b[i].full[k]);
            }
            for (std::size_t k = 0; k < 12; ++k) {
                length += a[i].simple[k] * a[i].simple[k];
                off += std::abs(a[i].simple[k] - b[i].simple[k]);
            }
            EXPECT_NEAR(length, 1.0, 1e-5);
            EXPECT_LT(off, 0.05); // of 128 or 12 numbers together
        }
    }
}

TEST(Features, AnEvenPictureHasNone) {
    const Grey even{120, 90, std::vector<float>(120 * 90, 0.4f)};
    EXPECT_TRUE(find_features(even, {}, Descriptor::full, {}).empty());
    EXPECT_TRUE(find_features(DepthView{}, Descriptor::full, {}).empty()); // without colours
}

TEST(GlobalRegistration, FindsTheMotionAmongWrongMatches) {
    Random random(3);
    Pose truth = Pose::Identity();
    truth.rotate(Eigen::AngleAxisd(1.0, Vec3d(1, 1, 0).normalized()));
    truth.pretranslate(Vec3d(0.4, -0.2, 0.3));
    std::vector<Feature> a(60), b(60);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (float& value : b[i].full)
            value = static_cast<float>(random.uniform());
        a[i].full = b[i].full; // each looks like its partner
        b[i].point = Vec3f(static_cast<float>(random.uniform(-0.4, 0.4)),
                           static_cast<float>(random.uniform(-0.8, 0.8)),
                           static_cast<float>(random.uniform(-2.2, -1.8)));
        a[i].point = (truth * b[i].point.cast<double>()).cast<float>();
        if (i % 3 != 0) a[i].point += Vec3f::Random(); // but mostly lies elsewhere
    }
    const auto found = register_features(a, b, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->matches, 60u);
    EXPECT_GE(found->agreeing, 20u);
    EXPECT_TRUE(found->a_from_b.isApprox(truth, 0.01));
    b.resize(5), a.resize(5);
    EXPECT_FALSE(register_features(a, b, {})); // too few
}

TEST(GlobalRegistration, PlainIcpNeedsANearStart) {
    Random random(6);
    std::vector<Vec3f> b;
    for (int k = 0; k < 3000; ++k) { // an elongated shell
        Vec3d p(random.normal(), random.normal(), random.normal());
        p = p.normalized().cwiseProduct(Vec3d(0.2, 0.5, 0.1));
        if (p.x() > 0.1) p.x() *= 1.5;
        b.push_back(p.cast<float>());
    }
    const auto off = [&](double degrees) {
        Pose start = Pose::Identity();
        start.rotate(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vec3d::UnitZ()));
        const Registered found = register_clouds(b, b, start, 1e-12, 200);
        return Eigen::AngleAxisd(found.pose.linear()).angle() * 180.0 / std::numbers::pi;
    };
    EXPECT_LT(off(8.0), 0.5);
    EXPECT_GT(off(170.0), 90.0);
}

TEST(VoxelGrid, KeepsOnePointACellAndItsCentreOfGravity) {
    Random random(1);
    std::vector<Vec3f> points;
    for (int k = 0; k < 4000; ++k)
        points.emplace_back(static_cast<float>(random.uniform()),
                            static_cast<float>(random.uniform(0.0, 2.0)),
                            static_cast<float>(random.uniform(0.0, 0.5)));
    // 4000 points in a cubic metre, eight a cell: cells of an eighth of a metre (eq. 1-2).
    const double cell = cell_size(points, 1.0, 8.0);
    EXPECT_NEAR(cell, std::cbrt(8.0 / 4000.0), 0.002);
    EXPECT_NEAR(cell_size(points, 2.0, 8.0), 2.0 * cell, 1e-9);
    const auto thin = thinned(points, cell);
    EXPECT_GT(thin.size(), 350u);
    EXPECT_LT(thin.size(), 900u);
    const std::vector<Vec3f> two = {{0.1f, 0.1f, 0.1f}, {0.3f, 0.1f, 0.1f}, {0.9f, 0.1f, 0.1f}};
    const auto grid = thinned(two, 0.5);
    ASSERT_EQ(grid.size(), 2u);
    EXPECT_NEAR(grid[0].x(), 0.2f, 1e-6f);
    EXPECT_EQ(thinned(two, 0.0).size(), 3u);
}

} // namespace
} // namespace toile::scan
