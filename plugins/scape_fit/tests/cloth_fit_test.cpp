// Bodies beneath cloth.
#include "room_cameras.h"
#include "scape_fit/cloth_gaps.h"
#include "scape_fit/cloth_looseness.h"

namespace toile::scape_fit {
namespace {

constexpr std::size_t kInstants = 3;

bool covered(std::size_t vertex) {
    const body::Part part = adult().space().model().parts[vertex];
    return part == body::Part::torso || part == body::Part::pelvis;
}

/// The person in something like a wide shirt: 5 to 45 mm off the trunk, other folds each time.
geometry::TriangleMesh dressed(const Somebody& who, std::size_t instant) {
    std::vector<Vec3f> normals(who.surface.positions.size());
    geometry::vertex_normals(who.surface.positions, who.surface.triangles, normals);
    geometry::TriangleMesh out = who.surface;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (!covered(v)) continue;
        const Vec3f& p = who.surface.positions[v];
        const float fold = std::sin(20.0f * p.y() + 2.0f * std::atan2(p.x(), p.z()) +
                                    2.1f * static_cast<float>(instant));
        out.positions[v] += (0.025f + 0.020f * fold) * normals[v];
    }
    return out;
}

/// Fits somebody in the shirt, seen from four sides.
const FitSession& fit_dressed(bool told, bool colors = false) {
    static FitSession one(adult());
    const Somebody who;
    std::vector<FitCamera> cameras;
    for (const float degrees : {0.0f, 90.0f, 180.0f, 270.0f}) {
        const float angle = degrees * body::kDegree;
        cameras.push_back(camera_at(Vec3f(2.4f * std::sin(angle), 1.0f, 2.4f * std::cos(angle))));
    }
    one.begin(cameras);
    std::vector<std::uint8_t> cloth;
    for (std::size_t v = 0; v < who.surface.positions.size(); ++v)
        cloth.push_back(covered(v) ? 1 : 0);
    for (std::size_t f = 0; f < kInstants; ++f) {
        const auto shown = dressed(who, f);
        std::vector<imaging::DepthImage> depths;
        std::vector<imaging::Image> pictures;
        for (const FitCamera& camera : cameras) {
            depths.push_back(depth_of(camera, &shown));
            if (colors) pictures.push_back(color_of(camera, shown, cloth));
        }
        one.add_instant(std::move(depths), std::move(pictures));
    }
    SessionOptions options;
    options.dressed = told;
    one.fit(options, &serial_rows);
    return one;
}

double girth(const body::Measurements& all, std::string_view name) {
    for (const body::Measurement& m : all)
        if (m.name == name) return m.value_m;
    ADD_FAILURE() << name;
    return 0.0;
}

TEST(ClothFit, TheBodyDoesNotBulgeWithItsClothes) {
    const Somebody who;
    const body::Measurer measurer(adult().space().model());
    const auto rest = rest_shape(adult(), who.shape);
    const auto truth = measurer.measure(rest.positions, rest.skeleton);
    const FitSession& found = fit_dressed(true);
    const auto beneath = found.measurements();
    const auto looseness = found.report().at("looseness");
    const auto as_seen = fit_dressed(false).measurements();
    for (const char* name : {"waist_girth", "hip_girth", "bust_girth"}) {
        const double off = girth(beneath, name) - girth(truth, name);
        const double bulge = girth(as_seen, name) - girth(truth, name);
        EXPECT_GT(bulge, 0.05) << name;
        EXPECT_LT(std::abs(off), 0.5 * bulge) << name;
    }
    // Bare legs.
    EXPECT_NEAR(girth(beneath, "calf_girth"), girth(truth, "calf_girth"), 0.012);
    const auto loose = [&](const char* name) {
        return looseness.at(name).at("looseness").get<double>();
    };
    EXPECT_GT(loose("waist_girth"), 2.0 * loose("calf_girth"));
    EXPECT_GT(looseness.at("waist_girth").at("ease_m").get<double>(), 0.04);
    EXPECT_FALSE(found.report().contains("looseness")); // of the fit that was told of no clothes
}

TEST(ClothFit, WhatHasTheColourOfTheFaceIsNotDrawnIn) {
    const Somebody who;
    const body::Measurer measurer(adult().space().model());
    const auto rest = rest_shape(adult(), who.shape);
    const auto truth = measurer.measure(rest.positions, rest.skeleton);
    EXPECT_FALSE(fit_dressed(true).report().contains("skin_share"));
    const FitSession& found = fit_dressed(true, true);
    const double share = found.report().at("skin_share").get<double>();
    EXPECT_GT(share, 0.4);
    EXPECT_LT(share, 0.7);
    const auto beneath = found.measurements();
    for (const char* name : {"calf_girth", "knee_girth", "upper_arm_girth"})
        EXPECT_NEAR(girth(beneath, name), girth(truth, name), 0.008) << name;
}

std::uint32_t nearest_vertex(const FitLevel& level, body::Joint joint) {
    const Vec3f place = adult().space().model().skeleton.rest(joint);
    std::uint32_t best = 0;
    for (std::uint32_t v = 1; v < level.vertices.size(); ++v)
        if ((level.mean[v] - place).squaredNorm() < (level.mean[best] - place).squaredNorm())
            best = v;
    return best;
}

/// Pairs of a whole body at an instant: cloth 40 mm off around a place, else on the skin.
Association pairs_around(const FitLevel& level, const Vec3f& place) {
    Association out;
    for (std::uint32_t v = 0; v < level.vertices.size(); ++v) {
        VertexPair pair;
        pair.vertex = v;
        pair.weight = pair.observed = level.areas[v];
        pair.distance = (level.mean[v] - place).norm() < 0.2f ? -0.04f : -0.001f;
        out.pairs.push_back(pair);
    }
    return out;
}

TEST(ClothGaps, LooseClothIsBelievedLessThanTightClothAndSkinNeverOutsideOfIt) {
    const FitLevel& level = adult().level(1);
    ClothGaps gaps(level, {});
    const std::uint32_t loose = nearest_vertex(level, body::Joint::spine);
    const std::uint32_t knee = nearest_vertex(level, body::Joint::left_lower_leg);
    const Association pairs = pairs_around(level, level.mean[loose]);
    gaps.learn({&pairs, 1});
    EXPECT_GT(gaps.gap(loose), 0.03f);
    EXPECT_LT(gaps.weight(loose, -0.04f), 0.01f);
    EXPECT_EQ(gaps.weight(loose, 0.01f), 1.0f); // skin outside of the cloth
    EXPECT_EQ(gaps.weight(knee, -0.01f), 1.0f);
}

TEST(ClothGaps, WhatHasTheColourOfSkinIsBare) {
    const FitLevel& level = adult().level(1);
    ClothGaps gaps(level, {});
    const std::uint32_t belly = nearest_vertex(level, body::Joint::spine);
    const std::uint32_t knee = nearest_vertex(level, body::Joint::left_lower_leg);
    Association pairs = pairs_around(level, level.mean[knee]);
    for (VertexPair& pair : pairs.pairs) {
        const bool leg = level.mean[pair.vertex].y() < level.mean[knee].y() + 0.15f;
        // One pixel in ten is taken for the other.
        pair.bare = (leg ? 0.9f : 0.1f) * pair.observed;
        pair.covered = pair.observed - pair.bare;
    }
    EXPECT_LT(gaps.weight(knee, -0.04f), 0.1f); // nothing is known yet
    gaps.find_bare({&pairs, 1});
    EXPECT_TRUE(gaps.bare(knee));
    EXPECT_FALSE(gaps.bare(belly));
    EXPECT_EQ(gaps.weight(knee, -0.04f), 1.0f);
    gaps.learn({&pairs, 1});
    EXPECT_EQ(gaps.weight(knee, -0.04f), 1.0f);
}

} // namespace
} // namespace toile::scape_fit
