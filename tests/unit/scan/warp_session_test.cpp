#include "scan/warp_session.h"

#include "core/error.h"
#include "support/depth_pictures.h"

#include <gmock/gmock.h>
#include <numbers>

namespace toile::scan {
namespace {

using testing::HasSubstr;

constexpr int kViews = 16;

Pose camera_at(int k) {
    return test::camera_around(2.0 * std::numbers::pi * k / kViews);
}

std::vector<float> picture(int k) {
    static const geometry::TriangleMesh mesh = test::lump();
    static const geometry::NearestSurface surface(mesh.positions, mesh.triangles);
    return test::depth_picture(surface, test::small_depth_camera(), camera_at(k), 0.001f,
                               static_cast<std::uint64_t>(k) + 1);
}

/// The lump as it stood before the camera.
geometry::TriangleMesh body(int k, double wrong_turn = 0.0) {
    geometry::TriangleMesh out = test::lump();
    const Eigen::AngleAxisd turn(wrong_turn, Vec3d::UnitY());
    for (Vec3f& p : out.positions)
        p = (camera_at(k).inverse() * (turn * p.cast<double>())).cast<float>();
    return out;
}

/// Small and quick: what is told and refused, not how exact.
WarpSession session(WarpSessionOptions options = {}) {
    options.warp.rounds = 1;
    options.warp.nodes = 12;
    options.warp.bias_rounds = 0;
    options.warp.voxel_m = 0.01f;
    options.warp.truncation_m = 0.03f;
    return {{test::small_depth_camera(), std::nullopt}, options, serial_rows};
}

std::string reason(WarpSession& of) {
    try {
        (void)of.finish([](double) {});
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(WarpSession, SaysWhyNothingCanBeMade) {
    WarpSession none = session(), empty = session();
    EXPECT_THAT(reason(none), HasSubstr("no frame was fed"));
    empty.add(std::vector<float>(32000, std::nanf("")), {});
    EXPECT_THAT(reason(empty), HasSubstr("nobody is in view in any of 1 frames"));
    WarpSession one = session();
    one.add(picture(0), {});
    one.guide(0, body(0), {});
    EXPECT_THAT(reason(one), HasSubstr("a single view shows one side only"));
}

TEST(WarpSession, ABodyThatTurnsElsewhereThanTheTrunkIsNotBelieved) {
    WarpSession of = session();
    for (int k = 0; k < kViews; ++k)
        of.add(picture(k), {});
    for (const int k : {0, 4, 8, 12})
        of.guide(static_cast<std::uint32_t>(k), body(k, k == 8 ? std::numbers::pi : 0.0), {});
    const WarpSessionResult result = of.finish([](double) {});
    EXPECT_EQ(result.report.at("template"), "body");
    EXPECT_EQ(result.report.at("template_refused"), 1);
    EXPECT_EQ(result.report.at("template_instants"), 3);
    EXPECT_GT(result.report.at("bound_share"), 0.95);
}

TEST(WarpSession, WithoutABodyWhatKeptStillIsTheTemplate) {
    WarpSession of = session();
    for (int k = 0; k < kViews; ++k)
        of.add(picture(k), {});
    const WarpSessionResult result = of.finish([](double) {});
    EXPECT_EQ(result.report.at("template"), "what kept still");
    EXPECT_EQ(result.report.at("frames"), kViews);
    EXPECT_TRUE(geometry::check_topology(result.mesh.positions, result.mesh.triangles).closed());
}

TEST(WarpSession, KeepsSoManyViewsSpreadEvenly) {
    WarpSessionOptions options;
    options.subject.most_views = 8;
    MovingSubject subject({test::small_depth_camera(), std::nullopt}, options.subject, serial_rows);
    for (int k = 0; k < kViews; ++k)
        subject.add(picture(k), {});
    ASSERT_EQ(subject.views().size(), 8u);
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(subject.views()[i].number, 2 * i);
    EXPECT_EQ(subject.intake().fed(), static_cast<std::size_t>(kViews));
}

TEST(WarpSession, RefusesAnotherBody) {
    WarpSession of = session();
    of.add(picture(0), {});
    of.guide(0, body(0), {});
    geometry::TriangleMesh other = body(1);
    other.triangles.pop_back();
    EXPECT_THROW(of.guide(1, other, {}), Error);
    const std::vector<std::uint8_t> few(3, 1);
    EXPECT_THROW(of.guide(1, body(1), few), Error);
}

} // namespace
} // namespace toile::scan
