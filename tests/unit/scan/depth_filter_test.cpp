#include "scan/depth_filter.h"

#include "scan/subject.h"
#include "support/depth_pictures.h"

#include <gtest/gtest.h>

namespace toile::scan {
namespace {

using test::camera_around;
using test::depth_picture;
using test::small_depth_camera;

/// A plane through (0, 0, -1) with this normal, in the camera frame.
std::vector<float> plane_picture(const imaging::Intrinsics& camera, const Vec3d& normal) {
    std::vector<float> out;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const Vec3d ray((x - camera.cx) / camera.fx, (camera.cy - y) / camera.fy, -1.0);
            out.push_back(static_cast<float>(normal.dot(Vec3d(0, 0, -1)) / normal.dot(ray)));
        }
    return out;
}

DepthView filtered(const imaging::Intrinsics& camera, const std::vector<float>& depth,
                   const FilterOptions& options) {
    const std::vector<std::uint8_t> all(depth.size(), 1);
    return filtered_view({camera, depth, {}}, all, options, serial_rows);
}

TEST(DepthFilter, APlaneStaysWhereItIsAndShowsItsNormal) {
    const auto camera = small_depth_camera();
    const Vec3d normal = Vec3d(0.4, -0.3, 1.0).normalized();
    const auto depth = plane_picture(camera, normal);
    FilterOptions options;
    options.edge_pixels = 0;
    const DepthView view = filtered(camera, depth, options);
    ASSERT_EQ(view.camera.width, camera.width);
    for (int y = 8; y < camera.height - 8; ++y)
        for (int x = 8; x < camera.width - 8; ++x) {
            const std::size_t i = view.camera.at(x, y);
            ASSERT_NEAR(view.depth[i], depth[i], 2e-6f);
            ASSERT_GT(view.normals[i].dot(normal.cast<float>()), 0.9999f);
        }
}

TEST(DepthFilter, FlyingPixelsAndEdgesAreDropped) {
    const auto camera = small_depth_camera();
    // The left half stands 0.3 m nearer; one pixel flies in between.
    std::vector<float> depth(32000, 1.3f);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 80; ++x)
            depth[static_cast<std::size_t>(160 * y + x)] = 1.0f;
    depth[160 * 50 + 40] = 1.15f;
    FilterOptions none;
    none.flying_pixels = none.joint_bilateral = false;
    none.edge_pixels = 0;
    const DepthView raw = filtered(camera, depth, none);
    EXPECT_FLOAT_EQ(raw.raw[raw.camera.at(40, 50)], 1.15f);
    FilterOptions flying = none;
    flying.flying_pixels = true;
    const DepthView view = filtered(camera, depth, flying);
    EXPECT_EQ(view.raw[view.camera.at(40, 50)], 0.0f);
    EXPECT_FLOAT_EQ(view.raw[view.camera.at(79, 100)], 1.0f); // an edge does not fly
    FilterOptions edges = flying;
    edges.edge_pixels = 2;
    const DepthView cut = filtered(camera, depth, edges);
    for (const int x : {78, 79, 80, 81})
        EXPECT_EQ(cut.depth[cut.camera.at(x, 100)], 0.0f) << x;
    for (const int x : {76, 83})
        EXPECT_GT(cut.depth[cut.camera.at(x, 100)], 0.0f) << x;
}

TEST(DepthFilter, SmoothingTakesNoiseOffAndStopsAtColours) {
    const auto camera = small_depth_camera();
    Random random(3);
    std::vector<float> depth(32000);
    std::vector<Rgba8> colors(depth.size());
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const bool left = i % 160 < 80;
        // A step of 6 mm at an edge of colour, below what depth alone tells from noise.
        depth[i] = (left ? 1.0f : 1.006f) + static_cast<float>(0.002 * random.uniform(-1.0, 1.0));
        colors[i] = left ? Rgba8{200, 30, 30, 255} : Rgba8{20, 40, 180, 255};
    }
    const std::vector<std::uint8_t> all(depth.size(), 1);
    FilterOptions options;
    options.edge_pixels = 0;
    const auto spread = [&](const DepthView& view, int x, float wanted) {
        double square = 0.0;
        for (int y = 20; y < 180; ++y)
            square += std::pow(view.depth[view.camera.at(x, y)] - wanted, 2);
        return std::sqrt(square / 160.0);
    };
    const DepthView with = filtered_view({camera, depth, colors}, all, options, serial_rows);
    const DepthView without = filtered_view({camera, depth, {}}, all, options, serial_rows);
    EXPECT_LT(spread(with, 40, 1.0f), 0.0004);    // uniform noise of 2 mm has 1.15 mm
    EXPECT_LT(spread(with, 79, 1.0f), 0.0012);    // at the edge
    EXPECT_GT(spread(without, 79, 1.0f), 0.0018); // which depth alone smears
}

TEST(DepthFilter, WhatSmoothingTakesOffABallIsPutBack) {
    const auto camera = small_depth_camera();
    const auto ball = test::sphere(0.06f, 6);
    const geometry::NearestSurface surface(ball.positions, ball.triangles);
    const auto depth = depth_picture(surface, camera, camera_around(0.0));
    std::vector<std::uint8_t> mask;
    for (const float d : depth)
        mask.push_back(d > 0.0f ? 1 : 0);
    FilterOptions options;
    options.radius = 4;
    DepthView view = filtered_view({camera, depth, {}}, mask, options, serial_rows);
    const auto off = [&] {
        double sum = 0.0, count = 0.0;
        for (std::size_t i = 0; i < view.depth.size(); ++i)
            if (view.depth[i] > 0.0f) sum += view.depth[i] - view.raw[i], count += 1.0;
        return sum / count;
    };
    EXPECT_GT(off(), 0.0003); // bends are flattened: the ball recedes
    take_off_bias(view, view.raw, options);
    EXPECT_LT(std::abs(off()), 1e-5);
}

TEST(DepthFilter, TheMeanOfSeveralPicturesHasLessNoiseAndForgetsOutliers) {
    std::vector<std::vector<float>> pictures;
    Random random(1);
    for (int k = 0; k < 16; ++k) {
        std::vector<float>& picture = pictures.emplace_back(1000);
        for (float& d : picture)
            d = 1.0f + static_cast<float>(0.004 * random.uniform(-1.0, 1.0));
        picture[7] = k < 3 ? 2.0f : picture[7]; // sometimes the wall behind
        if (k < 9) picture[8] = std::nanf("");  // mostly nothing
    }
    const auto mean = averaged_depth(pictures);
    double square = 0.0;
    for (std::size_t i = 9; i < mean.size(); ++i)
        square += std::pow(mean[i] - 1.0f, 2) / 991.0;
    EXPECT_LT(std::sqrt(square), 0.004 / std::sqrt(3.0) / 4.0 * 1.15);
    EXPECT_NEAR(mean[7], 1.0f, 0.004f);
    EXPECT_TRUE(std::isnan(mean[8]));
}

/// The lump on a floor or on a podium of 10 cm, before a wall, is found and nothing else.
void expect_lump_found(bool podium) {
    const auto camera = small_depth_camera();
    geometry::TriangleMesh scene = test::lump();
    const std::size_t own = scene.triangles.size();
    const auto add = [&](const geometry::TriangleMesh& box) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        scene.positions.insert(scene.positions.end(), box.positions.begin(), box.positions.end());
        for (const Triangle& t : box.triangles)
            scene.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    };
    const float floor = podium ? -0.34f : -0.24f;
    add(test::box({-3, floor - 0.1f, -3}, {3, floor, 3}));
    if (podium) add(test::box({-0.25f, -0.34f, -0.25f}, {0.25f, -0.24f, 0.25f}));
    add(test::box({-3, -0.3f, -1.1f}, {3, 3, -1}));
    const geometry::NearestSurface surface(scene.positions, scene.triangles);
    Eigen::Isometry3d place = camera_around(0.2, 1.4);
    place.translation().y() += 0.4;
    place.rotate(Eigen::AngleAxisd(-0.27, Vec3d::UnitX())); // looks down on it
    const auto depth = depth_picture(surface, camera, place);
    const Vec3f up = (place.linear().transpose() * Vec3d::UnitY()).cast<float>();
    const Subject found = find_subject({camera, depth, {}}, up);
    ASSERT_EQ(found.trouble, "");
    ASSERT_TRUE(found.floor);
    EXPECT_GT(found.floor->normal.dot(up), 0.999f);
    const Vec3f top = place.inverse().cast<float>() * Vec3f(0, -0.24f, 0);
    EXPECT_NEAR(found.floor->normal.dot(top) - found.floor->offset, 0.0f, 0.01f);
    const Eigen::Isometry3f pose = place.cast<float>();
    std::size_t wrong = 0, missed = 0, count = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const Vec3f ray(static_cast<float>((x - camera.cx) / camera.fx),
                            static_cast<float>((camera.cy - y) / camera.fy), -1.0f);
            const auto hit = surface.first_hit(pose.translation(), pose.linear() * ray);
            const auto i = static_cast<std::size_t>(y * camera.width + x);
            const bool its = hit && hit->triangle < own;
            count += its ? 1 : 0;
            wrong += !its && found.mask[i] != 0 ? 1 : 0;
            missed += its && found.mask[i] == 0 ? 1 : 0;
        }
    EXPECT_EQ(wrong, 0u);
    EXPECT_LT(missed, count / 20); // the lowest 3 cm
}

TEST(Subject, IsTakenOffFloorAndWall) {
    expect_lump_found(false);
}

TEST(Subject, IsTakenOffThePodiumItStandsOn) {
    expect_lump_found(true);
}

/// A wall that is read with holes: inside of it no reading is lost, round a hole that the room
/// behind is seen through they are.
TEST(DepthFilter, HolesInASurfaceAreNoEdges) {
    const auto camera = small_depth_camera();
    std::vector<float> depth(32000, 1.5f);
    const auto punch = [&](int x0, float value) {
        for (int y = 80; y < 90; ++y)
            for (int x = x0; x < x0 + 10; ++x)
                depth[static_cast<std::size_t>(y * camera.width + x)] = value;
    };
    punch(40, std::nanf(""));
    punch(100, 3.0f);
    std::vector<std::uint8_t> subject(32000, 1);
    for (std::size_t i = 0; i < depth.size(); ++i)
        subject[i] = depth[i] == 3.0f ? 0 : 1;
    const DepthView view =
        filtered_view({camera, depth, {}}, subject, {.joint_bilateral = false}, serial_rows);
    const auto reads = [&](int x, int y) {
        return view.depth[view.camera.at(x - view.around[0], y - view.around[1])] > 0.0f;
    };
    for (int y = 80; y < 90; ++y) {
        EXPECT_TRUE(reads(39, y) && reads(50, y)) << y;
        EXPECT_FALSE(reads(99, y) || reads(98, y) || reads(110, y)) << y;
        EXPECT_TRUE(reads(97, y)) << y;
    }
}

TEST(Subject, AnEmptyRoomHasNone) {
    const auto camera = small_depth_camera();
    const std::vector<float> nothing(32000, std::nanf("")), wall(32000, 6.0f);
    EXPECT_NE(find_subject({camera, nothing, {}}, Vec3f::UnitY()).trouble, "");
    EXPECT_NE(find_subject({camera, wall, {}}, Vec3f::UnitY()).trouble, "");
}

} // namespace
} // namespace toile::scan
