// Garments modelled in another pose, and what a retailer's mesh is made of.
#include "body/avatar_anatomy.h"
#include "body/skinning.h"
#include "body/usual_poses.h"
#include "garment/openings.h"
#include "garment/pose_match.h"
#include "geometry/nearest_surface.h"
#include "support/figure.h"
#include "support/throws.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::garment {
namespace {

using body::Joint;
using body::Part;

const body::BodyModel& figure_model() {
    static const body::BodyModel model = [] {
        const test::Figure figure = test::figure();
        body::BodyModel out;
        out.id = "figure";
        out.rest = figure.mesh;
        out.skeleton = figure.skeleton;
        out.skin = figure.skin;
        for (const auto& joints : figure.skin.joints)
            out.parts.push_back(body::part_of(static_cast<Joint>(joints[0])));
        return out;
    }();
    return model;
}

/// Moved as the skin next to it moves into the pose.
geometry::TriangleMesh worn_in(const geometry::TriangleMesh& garment, const body::ArmPose& arms) {
    const body::BodyModel& model = figure_model();
    body::Pose pose = body::usual_pose(model.skeleton, arms, 0.0f);
    pose.hips_position = model.skeleton.rest(Joint::hips);
    const auto skinning =
        body::skinning_transforms(model.skeleton, body::forward_kinematics(model.skeleton, pose));
    const geometry::NearestSurface skin(model.rest.positions, model.rest.triangles);
    body::SkinWeights weights;
    for (const Vec3f& p : garment.positions) {
        const std::uint32_t v = model.rest.triangles[skin.nearest(p).triangle][0];
        weights.joints.push_back(model.skin.joints[v]);
        weights.weights.push_back(model.skin.weights[v]);
    }
    geometry::TriangleMesh out = garment;
    body::SkinnedSurface(garment.positions, {}, weights.joints, weights.weights)
        .pose(skinning, body::SkinningMethod::linear_blend,
              body::VectorRows(std::span(out.positions)), {});
    return out;
}

geometry::TriangleMesh long_shirt() {
    const test::Figure figure = test::figure();
    return test::part_of(test::iso_surface([&](const Vec3f& p) { return figure.field(p) - 0.012f; },
                                           Vec3f(-0.9f, 0.7f, -0.35f), Vec3f(0.9f, 1.7f, 0.35f),
                                           0.02f),
                         [](const Vec3f& p) {
                             const bool neckline = p.y() > 1.41f && std::abs(p.x()) < 0.1f;
                             return p.y() > 0.88f && std::abs(p.x()) < 0.48f && !neckline;
                         });
}

double mean_distance(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    double sum = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v)
        sum += static_cast<double>((a[v] - b[v]).norm());
    return sum / static_cast<double>(a.size());
}

TEST(PoseMatch, AShirtOfAnotherPoseIsLaidIntoThisOne) {
    const geometry::TriangleMesh shirt = long_shirt();
    for (const float lift : {30.0f, -20.0f}) {
        geometry::TriangleMesh raised = worn_in(shirt, {0.0f, lift, 8.0f, 0.0f, 0.0f});
        const double before = mean_distance(raised.positions, shirt.positions);
        const PoseMatch match = match_pose(figure_model(), raised.triangles, raised.positions);
        ASSERT_TRUE(match.moved());
        EXPECT_NEAR(match.lift, lift, 7.0f);
        EXPECT_LT(match.after_m, 0.8 * match.before_m);
        EXPECT_LT(mean_distance(raised.positions, shirt.positions), 0.35 * before)
            << match.text() << match.shift;
        EXPECT_EQ(match.turns.size(), raised.positions.size());
        EXPECT_THAT(match.text(), testing::HasSubstr("modelled in another pose"));
    }
}

TEST(PoseMatch, WhatSitsStaysAsItIs) {
    for (const geometry::TriangleMesh& garment :
         {long_shirt(), test::shirt_on(test::figure(), 0.012f), test::skirt_on(0.3f)}) {
        std::vector<Vec3f> positions = garment.positions;
        const PoseMatch match = match_pose(figure_model(), garment.triangles, positions);
        EXPECT_FALSE(match.moved()) << match.text();
        EXPECT_EQ(positions, garment.positions);
    }
}

std::vector<Part> around(const Piece& piece) {
    std::vector<Part> out;
    for (const Opening& opening : piece.openings)
        out.push_back(opening.around);
    return out;
}

TEST(Openings, AShirtHasFourAndHangsByItself) {
    const geometry::TriangleMesh shirt = test::shirt_on(test::figure(), 0.012f);
    const auto pieces = find_pieces(shirt, figure_model());
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].openings.size(), 4u);
    EXPECT_THAT(around(pieces[0]),
                testing::IsSupersetOf({Part::left_upper_arm, Part::right_upper_arm}));
    EXPECT_TRUE(pieces[0].on_shoulders);
    EXPECT_TRUE(propose_pins(shirt, pieces).empty());
}

TEST(Openings, ASkirtIsHeldByItsUpperBorder) {
    const geometry::TriangleMesh skirt = test::skirt_on(0.3f);
    const auto pieces = find_pieces(skirt, figure_model());
    ASSERT_EQ(pieces.size(), 1u);
    ASSERT_EQ(pieces[0].openings.size(), 2u);
    EXPECT_GT(pieces[0].openings[0].length_m, pieces[0].openings[1].length_m);
    const auto pins = propose_pins(skirt, pieces);
    ASSERT_EQ(pins.size(), 1u);
    EXPECT_EQ(pins[0].name, "waistband");
    for (std::size_t v = 0; v < skirt.positions.size(); ++v) {
        const float below = 1.05f - skirt.positions[v].y();
        EXPECT_EQ(pins[0].mask[v] == 1.0f, below < 0.001f);
        EXPECT_EQ(pins[0].mask[v] > 0.0f, below < 0.06f) << below;
    }
}

TEST(Openings, HatsAreHeldAsAWhole) {
    geometry::TriangleMesh hat = test::part_of(
        test::iso_surface(
            [figure = test::figure()](const Vec3f& p) { return figure.field(p) - 0.01f; },
            Vec3f(-0.2f, 1.4f, -0.25f), Vec3f(0.2f, 1.9f, 0.25f), 0.02f),
        [](const Vec3f& p) { return p.y() > 1.62f; });
    const auto pieces = find_pieces(hat, figure_model());
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].parts, std::vector<Part>{Part::head});
    const auto pins = propose_pins(hat, pieces);
    ASSERT_EQ(pins.size(), 1u);
    EXPECT_EQ(pins[0].vertices.size(), hat.positions.size());
}

TEST(Openings, WhatLiesOverWhatIsTold) {
    geometry::TriangleMesh both = test::shirt_on(test::figure(), 0.012f);
    const geometry::TriangleMesh outer = test::shirt_on(test::figure(), 0.03f);
    const auto base = static_cast<std::uint32_t>(both.positions.size());
    both.positions.insert(both.positions.end(), outer.positions.begin(), outer.positions.end());
    for (const Triangle& t : outer.triangles)
        both.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    const auto pieces = find_pieces(both, figure_model());
    ASSERT_EQ(pieces.size(), 2u);
    const auto lines = tell_pieces(pieces);
    const std::string over = pieces[0].gap_m > pieces[1].gap_m ? "piece 1 lies over piece 2"
                                                               : "piece 2 lies over piece 1";
    EXPECT_THAT(lines, testing::Contains(testing::HasSubstr(over)));
}

TEST(Openings, ABodyWithoutLabelsIsRefused) {
    body::BodyModel plain = figure_model();
    plain.parts.clear();
    EXPECT_ERROR(static_cast<void>(find_pieces(test::skirt_on(0.3f), plain)), "has no part labels");
}

} // namespace
} // namespace toile::garment
