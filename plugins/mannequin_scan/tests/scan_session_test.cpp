// Scans of the body space's people: units, the way up, parts and joints.
#include "mannequin_scan/scan_session.h"

#include "body/fit_model.h"
#include "mannequin_scan/part_body.h"
#include "support/meshes.h"
#include "support/throws.h"

#include <gtest/gtest.h>

namespace toile::mannequin_scan {
namespace {

const body::FitModel& adult() {
    static const body::FitModel kModel(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" /
                                       "adult");
    return kModel;
}

body::PosedLevel mean_adult() {
    body::PosedLevel out;
    body::pose_level(adult(), adult().level(0),
                     {body::ShapeVector::Zero(adult().component_count()), {}}, {}, out);
    return out;
}

geometry::TriangleMesh scan_of(float scale) {
    geometry::TriangleMesh out{mean_adult().positions, {}, adult().level(0).triangles};
    for (Vec3f& p : out.positions)
        p *= scale;
    return out;
}

TEST(MannequinScan, UnitsAreFound) {
    for (const auto& [scale, unit] :
         {std::pair(1.0f, "m"), std::pair(1000.0f, "mm"), std::pair(100.0f, "cm")}) {
        const CleanScan scan = clean_scan(scan_of(scale), {});
        EXPECT_EQ(scan.unit, unit);
        ASSERT_TRUE(scan.parts) << scan.why_no_parts;
        float high = -1e9f, low = 1e9f;
        for (const Vec3f& p : scan.clean.mesh.positions) {
            high = std::max(high, p.y());
            low = std::min(low, p.y());
        }
        EXPECT_TRUE(high - low > 1.6f && high - low < 1.9f) << high - low;
    }
}

TEST(MannequinScan, JointsAreWhereTheBodyBends) {
    const CleanScan scan = clean_scan(scan_of(1.0f), {});
    const PartBody person(scan, 1);
    const auto truth = mean_adult().world;
    for (const int joint :
         {TOILE_JOINT_LEFT_LOWER_ARM, TOILE_JOINT_RIGHT_LOWER_ARM, TOILE_JOINT_LEFT_LOWER_LEG,
          TOILE_JOINT_RIGHT_LOWER_LEG, TOILE_JOINT_NECK, TOILE_JOINT_SPINE}) {
        const auto j = static_cast<std::size_t>(joint);
        EXPECT_LT((person.joints()[j] - truth[j].translation).norm(), 0.08f)
            << body::joint_name(static_cast<body::Joint>(j));
    }
}

TEST(MannequinScan, ColoursComeAlong) {
    const auto scan = scan_of(1.0f);
    std::vector<Rgba> colors;
    for (const Vec3f& p : scan.positions)
        colors.push_back(p.x() > 0.0f ? Rgba{255, 0, 0, 255} : Rgba{0, 0, 255, 255});
    const CleanScan out = clean_scan(scan, colors);
    ASSERT_EQ(out.colors.size(), out.clean.mesh.positions.size());
    for (std::size_t v = 0; v < out.colors.size(); ++v)
        if (std::abs(out.clean.mesh.positions[v].x()) > 0.02f) {
            EXPECT_EQ(out.colors[v][0] > 0, out.clean.mesh.positions[v].x() > 0.0f);
        }
}

TEST(MannequinScan, WhatIsNoUprightPersonIsRefused) {
    auto lying = scan_of(1.0f);
    for (Vec3f& p : lying.positions)
        p = Vec3f(p.x(), -p.z(), p.y());
    EXPECT_ERROR((void)clean_scan(lying, {}), "upright");
    EXPECT_ERROR((void)clean_scan(test::sphere(0.004f, 3), {}), "as large as a person");
    EXPECT_ERROR((void)clean_scan({}, {}), "no surface");
    const CleanScan ball = clean_scan(test::sphere(0.9f, 4), {});
    EXPECT_FALSE(ball.parts);
    EXPECT_ERROR(PartBody(ball, 1), "a person's parts");
}

} // namespace
} // namespace toile::mannequin_scan
