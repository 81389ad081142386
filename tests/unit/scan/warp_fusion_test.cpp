#include "scan/warp_fusion.h"

#include "core/error.h"
#include "scan/fusion.h"
#include "scan/subject.h"
#include "support/depth_pictures.h"
#include "support/meshes.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::scan {
namespace {

constexpr int kViews = 24;

/// The lump in one piece, coarse enough for a quick template.
const geometry::TriangleMesh& lump() {
    static const geometry::TriangleMesh mesh = test::lump();
    return mesh;
}

/// It bends to the side above its middle and swells below, back and forth in the turn.
geometry::TriangleMesh bent(int k) {
    geometry::TriangleMesh out = lump();
    const double phase = 2.0 * std::numbers::pi * k / 11.0;
    const auto lean = static_cast<float>(0.12 * std::sin(phase));
    const auto swell = static_cast<float>(0.008 * (1.0 - std::cos(phase)));
    for (Vec3f& p : out.positions) {
        const float above = std::max(0.0f, p.y() + 0.05f);
        p.x() += lean * above * std::min(1.0f, above / 0.1f);
        if (p.y() < 0.1f) p *= 1.0f + swell;
    }
    return out;
}

NumberedView view(int k, float noise_m) {
    const auto camera = test::small_depth_camera();
    const geometry::TriangleMesh mesh = bent(k);
    const geometry::NearestSurface surface(mesh.positions, mesh.triangles);
    const auto depth = test::depth_picture(surface, camera,
                                           test::camera_around(2.0 * std::numbers::pi * k / kViews),
                                           noise_m, static_cast<std::uint64_t>(k) + 1);
    const Subject subject = find_subject({camera, depth, {}}, Vec3f::UnitY());
    EXPECT_EQ(subject.trouble, "");
    return {static_cast<std::uint32_t>(k),
            filtered_view({camera, depth, {}}, subject.mask, {}, serial_rows)};
}

std::vector<NumberedView> views(float noise_m = 0.001f) {
    std::vector<NumberedView> out;
    for (int k = 0; k < kViews; ++k)
        out.push_back(view(k, noise_m));
    return out;
}

/// The unbent lump, as a stiff thing would have turned: all that a template knows here.
TemplatePoses stiff_poses() {
    TemplatePoses out;
    for (int k = 0; k < kViews; k += 2) {
        const Eigen::Isometry3f camera =
            test::camera_around(2.0 * std::numbers::pi * k / kViews).inverse().cast<float>();
        for (const Vec3f& p : lump().positions)
            out[static_cast<std::uint32_t>(k)].push_back(camera * p);
    }
    return out;
}

geometry::TriangleMesh shape() {
    geometry::TriangleMesh out = lump();
    out.positions = stiff_poses().at(0);
    return out;
}

MovingTemplate stiff_template() {
    return {shape(), stiff_poses(), {}};
}

/// Mean and 95 % of the distances from the lump as it was at first.
std::pair<double, double> off(const geometry::TriangleMesh& mesh) {
    const geometry::NearestSurface surface(shape().positions, lump().triangles);
    std::vector<float> all;
    double mean = 0.0;
    for (const Vec3f& p : mesh.positions) {
        all.push_back(surface.nearest(p).distance);
        mean += static_cast<double>(all.back()) / static_cast<double>(mesh.positions.size());
    }
    std::sort(all.begin(), all.end());
    return {mean, all[all.size() * 95 / 100]};
}

WarpFusionOptions options(int rounds) {
    WarpFusionOptions out;
    out.rounds = rounds;
    out.nodes = 40;
    out.joint.smoothness = 0.02;
    out.joint.steadiness = 0.002;
    out.joint.trust = 1e-4;
    return out;
}

const WarpedSurface& fused() {
    static const WarpedSurface surface = fuse_warped(views(), stiff_template(), std::nullopt,
                                                     options(10), {}, serial_rows, [](double) {});
    return surface;
}

TEST(WarpFusion, ABendingSubjectComesOutAsItWasAtFirst) {
    const WarpedSurface stiff = fuse_warped(views(), stiff_template(), std::nullopt, options(0), {},
                                            serial_rows, [](double) {});
    const auto [mean, most] = off(fused().mesh);
    EXPECT_LT(mean, 0.003);
    EXPECT_LT(most, 0.009);
    EXPECT_LT(2.0 * mean, off(stiff.mesh).first); // what registration is for
    EXPECT_TRUE(geometry::check_topology(fused().mesh.positions, fused().mesh.triangles).closed());
}

TEST(WarpFusion, RoundsBringTheViewsTogether) {
    const auto& rounds = fused().report.rounds;
    ASSERT_GE(rounds.size(), 3u);
    EXPECT_LT(rounds.back().rms_m, 0.5 * rounds.front().rms_m);
    EXPECT_GT(rounds.back().overlap, 0.3);
    EXPECT_LT(fused().report.loop_error_m, fused().report.loop_gap_m);
    EXPECT_GT(fused().report.largest_move_m, 0.01); // it did bend
    EXPECT_GT(fused().report.bound_share, 0.95);
}

/// The stiff lump with a box at its side, as somebody carries a bag.
std::vector<NumberedView> carrying() {
    geometry::TriangleMesh both = lump();
    const geometry::TriangleMesh bag = test::box({0.08f, -0.20f, -0.06f}, {0.25f, -0.09f, 0.06f});
    const auto first = static_cast<std::uint32_t>(both.positions.size());
    both.positions.insert(both.positions.end(), bag.positions.begin(), bag.positions.end());
    for (const Triangle& t : bag.triangles)
        both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    const geometry::NearestSurface surface(both.positions, both.triangles);
    const auto camera = test::small_depth_camera();
    std::vector<NumberedView> out;
    for (int k = 0; k < kViews; ++k) {
        const auto depth = test::depth_picture(
            surface, camera, test::camera_around(2.0 * std::numbers::pi * k / kViews), 0.001f,
            static_cast<std::uint64_t>(k) + 1);
        const Subject subject = find_subject({camera, depth, {}}, Vec3f::UnitY());
        out.push_back({static_cast<std::uint32_t>(k),
                       filtered_view({camera, depth, {}}, subject.mask, {}, serial_rows)});
    }
    return out;
}

/// Bags were bound to whatever was nearest, and became part of the hip.
TEST(WarpFusion, WhatIsCarriedIsLeftOutWhereTheBodyIsKnown) {
    PartStage parts;
    parts.groups.assign(lump().positions.size(), BodyGroup::trunk);
    const auto scanned = [&](std::vector<NumberedView> seen, const PartStage& stage) {
        return fuse_warped(std::move(seen), stiff_template(), std::nullopt, options(1), stage,
                           serial_rows, [](double) {});
    };
    const WarpedSurface with = scanned(carrying(), {});
    EXPECT_FALSE(with.report.carried_left_out); // nobody said that it is a body
    EXPECT_GT(off(with.mesh).second, 0.05);
    const WarpedSurface without = scanned(carrying(), parts);
    EXPECT_TRUE(without.report.carried_left_out);
    EXPECT_GT(without.report.beside_share, 0.02);
    EXPECT_LT(off(without.mesh).second, 0.02);
    const WarpedSurface empty_handed = scanned(views(), parts);
    EXPECT_FALSE(empty_handed.report.carried_left_out);
    EXPECT_LT(empty_handed.report.beside_share, 0.02);
}

TEST(WarpFusion, GivesTheSameBytesOnAnyNumberOfThreads) {
    const auto backwards = [](std::uint32_t count, std::uint32_t grain,
                              const std::function<void(std::uint32_t, std::uint32_t)>& body) {
        for (std::uint32_t range = (count + grain - 1) / grain; range-- > 0;)
            body(range * grain, std::min(count, (range + 1) * grain));
    };
    const WarpedSurface other = fuse_warped(views(), stiff_template(), std::nullopt, options(10),
                                            {}, backwards, [](double) {});
    EXPECT_EQ(other.mesh.triangles, fused().mesh.triangles);
    EXPECT_EQ(other.mesh.positions, fused().mesh.positions);
}

TEST(WarpFusion, ASingleViewIsRefused) {
    std::vector<NumberedView> one;
    one.push_back(view(0, 0.0f));
    EXPECT_THROW((void)fuse_warped(std::move(one), stiff_template(), std::nullopt, options(2), {},
                                   serial_rows, [](double) {}),
                 Error);
}

} // namespace
} // namespace toile::scan
