#include "scan/rig_fusion.h"

#include "core/error.h"
#include "scan/subject.h"
#include "support/depth_pictures.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::scan {
namespace {

using test::camera_around;
using test::depth_picture;
using test::small_depth_camera;

const geometry::NearestSurface& lump() {
    static const geometry::TriangleMesh mesh = test::lump();
    static const geometry::NearestSurface surface(mesh.positions, mesh.triangles);
    return surface;
}

/// The lump, turned by `turn`, as cameras see it.
std::vector<CameraView> instant(std::span<const Pose> cameras, double turn, std::uint64_t seed) {
    Pose subject = Pose::Identity();
    subject.rotate(Eigen::AngleAxisd(turn, Vec3d::UnitY()));
    std::vector<CameraView> out;
    for (std::uint32_t c = 0; c < cameras.size(); ++c) {
        const auto camera = small_depth_camera();
        const auto depth =
            depth_picture(lump(), camera, subject.inverse() * cameras[c], 0.002f, 16 * seed + c);
        const Subject found = find_subject({camera, depth, {}}, Vec3f::UnitY());
        EXPECT_EQ(found.trouble, "");
        out.push_back({c, filtered_view({camera, depth, {}}, found.mask, {}, serial_rows)});
    }
    return out;
}

/// Two cameras 100 degrees apart, which see hardly anything together at one time.
std::vector<Pose> two_cameras() {
    return {camera_around(0.2), camera_around(0.2 + 100.0 * std::numbers::pi / 180.0)};
}

Pose moved(const Pose& pose, double turn, const Vec3d& shift) {
    Pose out = pose;
    out.rotate(Eigen::AngleAxisd(turn, Vec3d(1, 2, -1).normalized()));
    out.pretranslate(shift);
    return out;
}

double off_lump(const geometry::TriangleMesh& mesh) {
    double mean = 0.0;
    for (const Vec3f& p : mesh.positions)
        mean += lump().nearest(p).distance / static_cast<double>(mesh.positions.size());
    return mean;
}

TEST(RigFusion, ATurningSubjectComesOutAsItStoodFirst) {
    const auto cameras = two_cameras();
    RigFusion fusion({}, cameras, serial_rows);
    for (int k = 0; k < 18; ++k)
        fusion.add(
            instant(cameras, 20.0 * k * std::numbers::pi / 180.0, static_cast<std::uint64_t>(k)));
    fusion.place({});
    EXPECT_EQ(fusion.report().instants, 18u);
    EXPECT_EQ(fusion.report().lost_instants, 0u);
    EXPECT_NEAR(fusion.report().turn_rad, 340.0 * std::numbers::pi / 180.0, 0.1);
    for (std::size_t c = 0; c < cameras.size(); ++c) // believed where they were not free
        EXPECT_TRUE(fusion.world_from_camera()[c].isApprox(cameras[c], 1e-12));
    const FusedSurface fused = fusion.finish(std::nullopt, [](double) {});
    EXPECT_LT(off_lump(fused.mesh), 0.0025);
}

TEST(RigFusion, WhatTurnsTellsWhereCamerasAre) {
    const auto cameras = two_cameras();
    const std::vector<Pose> wrong = {cameras[0], moved(cameras[1], 0.01, {0.008, -0.01, 0.005})};
    RigFusion fusion({}, wrong, serial_rows);
    for (int k = 0; k < 18; ++k)
        fusion.add(
            instant(cameras, 20.0 * k * std::numbers::pi / 180.0, static_cast<std::uint64_t>(k)));
    fusion.place({0.05, 0.1});
    EXPECT_TRUE(fusion.world_from_camera()[0].isApprox(cameras[0], 1e-12));
    const Pose off = cameras[1].inverse() * fusion.world_from_camera()[1];
    EXPECT_LT(off.translation().norm(), 0.003);
    EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.003);
    EXPECT_GT(fusion.report().cameras_moved_m, 0.008);
}

TEST(RigFusion, ASubjectThatKeepsStillIsSeenFromAllSides) {
    std::vector<Pose> cameras;
    for (int c = 0; c < 4; ++c)
        cameras.push_back(camera_around(0.5 * std::numbers::pi * c));
    RigFusion fusion({}, cameras, serial_rows);
    for (int k = 0; k < 3; ++k)
        fusion.add(instant(cameras, 0.0, static_cast<std::uint64_t>(k)));
    fusion.place({});
    const FusedSurface fused = fusion.finish(std::nullopt, [](double) {});
    EXPECT_LT(off_lump(fused.mesh), 0.003);
    EXPECT_LT(fusion.report().turn_rad, 0.05);
}

TEST(RigFusion, NothingSeenIsAnError) {
    RigFusion fusion({}, two_cameras(), serial_rows);
    fusion.add({});
    EXPECT_THROW(fusion.place({}), Error);
    EXPECT_THROW((void)fusion.finish(std::nullopt, [](double) {}), Error);
}

} // namespace
} // namespace toile::scan
