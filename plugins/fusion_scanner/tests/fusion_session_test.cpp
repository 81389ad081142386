#include "fusion_scanner/fusion_session.h"

#include "core/error.h"
#include "support/depth_pictures.h"

#include <gmock/gmock.h>
#include <numbers>

namespace toile::fusion_scanner {
namespace {

using test::camera_around;
using test::depth_picture;
using testing::HasSubstr;

std::vector<float> picture(double angle, float noise_m = 0.0f, std::uint64_t seed = 1) {
    static const geometry::TriangleMesh mesh = test::lump();
    static const geometry::NearestSurface surface(mesh.positions, mesh.triangles);
    return depth_picture(surface, test::small_depth_camera(), camera_around(angle), noise_m, seed);
}

std::string reason(FusionSession& session) {
    try {
        (void)session.finish([](double) {});
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

FusionSession session_of(SessionOptions options = {},
                         std::optional<Eigen::Isometry3d> place = std::nullopt) {
    return {{{test::small_depth_camera(), place}}, options, serial_rows};
}

void add(FusionSession& session, const std::vector<float>& depth) {
    const SessionPicture picture{0, depth, {}};
    session.add({&picture, 1});
}

TEST(FusionSession, SaysWhyNothingCanBeMade) {
    FusionSession none = session_of(), empty = session_of(), one = session_of();
    EXPECT_THAT(reason(none), HasSubstr("no frame was fed"));
    const std::vector<float> nothing(32000, std::nanf(""));
    add(empty, nothing);
    add(empty, nothing);
    EXPECT_THAT(reason(empty), HasSubstr("nobody is in view in any of 2 frames"));
    add(one, picture(0.0));
    EXPECT_THAT(reason(one), HasSubstr("a single view shows one side only"));
}

TEST(FusionSession, FramesWithoutTheSubjectArePassedOver) {
    FusionSession session = session_of();
    add(session, std::vector<float>(32000, std::nanf("")));
    for (int k = 0; k < 4; ++k)
        add(session, picture(0.15 * k));
    const SessionResult result = session.finish([](double) {});
    EXPECT_EQ(result.report.at("frames"), 4);
    EXPECT_EQ(result.report.at("frames_without_subject"), 1);
}

TEST(FusionSession, StandsInTheWorldOfAKnownCameraElseUprightOnZero) {
    const Eigen::Isometry3d place = camera_around(0.7);
    FusionSession known = session_of({}, place), unknown = session_of();
    for (int k = 0; k < 4; ++k) {
        add(known, picture(0.7 + 0.15 * k));
        add(unknown, picture(0.7 + 0.15 * k));
    }
    const auto box = [](const SessionResult& result) {
        Eigen::AlignedBox3f out;
        for (const Vec3f& p : result.mesh.positions)
            out.extend(p);
        return out;
    };
    const auto there = box(known.finish([](double) {})),
               upright = box(unknown.finish([](double) {}));
    EXPECT_NEAR(there.max().y(), 0.32f, 0.035f); // the lump's own height; its top is hardly seen
    EXPECT_NEAR(there.min().y(), -0.24f, 0.02f);
    EXPECT_FLOAT_EQ(upright.min().y(), 0.0f);
    EXPECT_NEAR(upright.sizes().y(), there.sizes().y(), 0.005f);
}

TEST(FusionSession, AveragedFramesHaveLessNoise) {
    const auto readings_rms = [](int averaged) {
        SessionOptions options;
        options.averaged_frames = averaged;
        FusionSession session = session_of(options);
        for (int k = 0; k < 16; ++k) // four places, four frames at each
            add(session, picture(0.15 * (k / 4), 0.01f, static_cast<std::uint64_t>(k) + 1));
        return session.finish([](double) {}).report.at("readings_rms_m").get<double>();
    };
    EXPECT_LT(readings_rms(4), 0.65 * readings_rms(1));
}

TEST(FusionSession, RoughReadingsAreSmoothedMoreWidely) {
    const auto radius = [](float noise_m) {
        FusionSession session = session_of();
        for (int k = 0; k < 3; ++k)
            add(session, picture(0.1 * k, noise_m, static_cast<std::uint64_t>(k) + 1));
        return session.finish([](double) {}).report.at("smoothing_radius").get<int>();
    };
    EXPECT_EQ(radius(0.001f), 3);
    EXPECT_EQ(radius(0.006f), 6);
}

TEST(FusionSession, ProgressMayStopIt) {
    struct Stop {};
    FusionSession session = session_of();
    for (int k = 0; k < 3; ++k)
        add(session, picture(0.15 * k));
    EXPECT_THROW((void)session.finish([](double) { throw Stop(); }), Stop);
}

} // namespace
} // namespace toile::fusion_scanner
