#include "mesh_garment/binder.h"

#include "core/error.h"
#include "geometry/mesh.h"
#include "support/figure.h"

#include <gtest/gtest.h>

namespace toile::mesh_garment {
namespace {

BodyView view_of(const test::Figure& f) {
    return {f.mesh.positions, f.mesh.triangles, f.skin.joints, f.skin.weights,
            f.skeleton.rest_positions};
}

GarmentView view_of(const geometry::TriangleMesh& mesh) {
    GarmentView garment;
    garment.positions = mesh.positions;
    garment.triangles = mesh.triangles;
    return garment;
}

const test::Figure& slim() {
    static const test::Figure f = test::figure();
    return f;
}
/// The same template, rounder and taller: vertices of `slim` carried along its normals.
const test::Figure& round() {
    static const test::Figure f = [] {
        test::Figure out = slim();
        std::vector<Vec3f> normals(out.mesh.positions.size());
        geometry::vertex_normals(out.mesh.positions, out.mesh.triangles, normals);
        for (std::size_t v = 0; v < normals.size(); ++v) {
            Vec3f& p = out.mesh.positions[v];
            const float up = (p.y() - 1.05f) / 0.15f;
            p = 1.06f * p + (0.006f + 0.03f * std::exp(-up * up)) * normals[v];
        }
        for (Vec3f& p : out.skeleton.rest_positions)
            p *= 1.06f;
        return out;
    }();
    return f;
}

float least_distance(const BodySurface& body, const geometry::TriangleMesh& mesh,
                     std::span<const Vec3f> positions) {
    float least = 1.0f;
    for (const Vec3f& p : positions)
        least = std::min(least, body.nearest(p).signed_distance);
    for (const Triangle& t : mesh.triangles) {
        const Vec3f centre = (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3.0f;
        least = std::min(least, body.nearest(centre).signed_distance);
    }
    return least;
}

float farthest(const BodySurface& body, std::span<const Vec3f> positions) {
    float far = 0.0f;
    for (const Vec3f& p : positions)
        far = std::max(far, body.nearest(p).signed_distance);
    return far;
}

void expect_weights(const body::SkinWeights& skin) {
    for (std::size_t v = 0; v < skin.weights.size(); ++v) {
        float sum = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_GE(skin.weights[v][k], 0.0f);
            EXPECT_LT(skin.joints[v][k], body::kJointCount);
            sum += skin.weights[v][k];
        }
        EXPECT_NEAR(sum, 1.0f, 1e-5f);
    }
}

TEST(Binder, TheFigureIsAClosedSurface) {
    EXPECT_TRUE(geometry::check_topology(slim().mesh.positions, slim().mesh.triangles).closed());
}

TEST(Binder, ShirtIsClearAndWeighted) {
    const BodySurface body(view_of(slim()));
    const auto shirt = test::shirt_on(slim(), 0.008f);
    ASSERT_GT(shirt.positions.size(), 1500u);
    const Binding bound = bind(body, nullptr, view_of(shirt));
    EXPECT_EQ(bound.clearance.short_of_ease, 0u);
    EXPECT_GE(least_distance(body, shirt, bound.positions), 0.004f);
    expect_weights(bound.skin);
}

TEST(Binder, PushesOutWhatIsInside) {
    const BodySurface body(view_of(slim()));
    const auto shirt = test::shirt_on(slim(), -0.006f); // 6 mm below the skin
    const Binding bound = bind(body, nullptr, view_of(shirt));
    EXPECT_EQ(bound.clearance.short_of_ease, 0u);
    EXPECT_GE(least_distance(body, shirt, bound.positions), 0.004f);
    EXPECT_LT(farthest(body, bound.positions), 0.03f); // no farther than needed
}

TEST(Binder, RestTargetsAreTheBoundPositionsAndMoveRigidly) {
    const BodySurface body(view_of(slim()));
    const auto skirt = test::skirt_on(0.26f);
    const Binding bound = bind(body, nullptr, view_of(skirt));
    const Targets targets(bound, slim().skeleton.rest_positions);
    body::JointTransforms world;
    for (std::size_t j = 0; j < world.size(); ++j)
        world[j].translation = slim().skeleton.rest_positions[j];
    std::vector<Vec3f> out(bound.positions.size());
    targets.evaluate(world, body::VectorRows(std::span<Vec3f>(out)));
    for (std::size_t v = 0; v < out.size(); ++v)
        EXPECT_LT((out[v] - bound.positions[v]).norm(), 1e-6f);

    const RigidTransform move{Quatf(Eigen::AngleAxisf(1.0f, Vec3f(1, 1, 0).normalized())),
                              Vec3f(1, 2, 3)};
    for (RigidTransform& joint : world)
        joint = move * joint;
    targets.evaluate(world, body::VectorRows(std::span<Vec3f>(out)));
    for (std::size_t v = 0; v < out.size(); ++v)
        EXPECT_LT((out[v] - move * bound.positions[v]).norm(), 5e-6f);
}

TEST(Binder, LoosePartsDoNotTear) {
    const BodySurface body(view_of(slim()));
    const auto poses = test_poses(slim().skeleton.rest_positions);
    struct Garment {
        const char* name;
        geometry::TriangleMesh mesh;
        float bound;
    };
    const std::array<Garment, 3> garments = {{{"bell skirt", test::skirt_on(0.30f), 1.9f},
                                              {"straight skirt", test::skirt_on(0.21f), 2.6f},
                                              {"shirt", test::shirt_on(slim(), 0.012f), 3.4f}}};
    for (const Garment& garment : garments) {
        const Binding bound = bind(body, nullptr, view_of(garment.mesh));
        const float worst =
            worst_stretch(bound.positions, garment.mesh.triangles, bound.skin, poses);
        std::printf("%s: worst stretch %.2f\n", garment.name, static_cast<double>(worst));
        EXPECT_LT(worst, garment.bound) << garment.name;
    }
}

TEST(Binder, SkirtBlendsAcrossTheMiddle) {
    const BodySurface body(view_of(slim()));
    const auto skirt = test::skirt_on(0.28f);
    const Binding bound = bind(body, nullptr, view_of(skirt));
    const auto left = [&bound](std::size_t v) {
        float sum = 0.0f;
        for (std::size_t k = 0; k < 4; ++k)
            if (bound.skin.joints[v][k] == static_cast<int>(body::Joint::left_upper_leg) ||
                bound.skin.joints[v][k] == static_cast<int>(body::Joint::left_lower_leg))
                sum += bound.skin.weights[v][k];
        return sum;
    };
    for (std::size_t i = 0; i < 64; ++i) // around the hem
        EXPECT_LT(std::abs(left(i) - left((i + 1) % 64)), 0.12f) << i;
    EXPECT_GT(left(16), left(48)); // and its left side follows the left leg more
}

TEST(Binder, CarriesToAnotherBodyOfTheTemplate) {
    const BodySurface from(view_of(slim()));
    const BodySurface to(view_of(round()));
    const auto shirt = test::shirt_on(slim(), 0.010f);
    const Binding bound = bind(to, &from, view_of(shirt));
    EXPECT_EQ(bound.clearance.short_of_ease, 0u);
    EXPECT_GE(least_distance(to, shirt, bound.positions), 0.004f);
    double mean = 0.0; // ease stays about what it was
    for (const Vec3f& p : bound.positions)
        mean += static_cast<double>(to.nearest(p).signed_distance);
    mean /= static_cast<double>(bound.positions.size());
    EXPECT_NEAR(mean, 0.010, 0.003);
}

TEST(Binder, CarriesToAFreeBodyByItsBones) {
    const test::Figure other = test::figure(1.12f, 1.08f, 0.03f);
    ASSERT_NE(other.mesh.positions.size(), slim().mesh.positions.size());
    const BodySurface from(view_of(slim()));
    const BodySurface to(view_of(other));
    const auto shirt = test::shirt_on(slim(), 0.010f);
    const Binding bound = bind(to, &from, view_of(shirt));
    EXPECT_EQ(bound.clearance.short_of_ease, 0u);
    EXPECT_GE(least_distance(to, shirt, bound.positions), 0.004f);
    EXPECT_LT(farthest(to, bound.positions), 0.08f);
}

TEST(Binder, SameInputSameBytes) {
    const BodySurface from(view_of(slim()));
    const BodySurface to(view_of(round()));
    const auto skirt = test::skirt_on(0.25f);
    const Binding a = bind(to, &from, view_of(skirt));
    const Binding b = bind(to, &from, view_of(skirt));
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.skin.weights, b.skin.weights);
    EXPECT_EQ(a.skin.joints, b.skin.joints);
}

TEST(Binder, GivenSkinAndPinsAreKept) {
    const BodySurface body(view_of(slim()));
    const auto skirt = test::skirt_on(0.25f);
    const std::size_t nv = skirt.positions.size();
    const std::vector<std::array<std::uint16_t, 4>> joints(nv, {1, 0, 0, 0});
    const std::vector<std::array<float, 4>> weights(nv, {1, 0, 0, 0});
    std::vector<float> pins(nv, 0.0f);
    pins[nv - 1] = 0.5f;
    GarmentView garment = view_of(skirt);
    garment.joint_indices = joints;
    garment.joint_weights = weights;
    garment.pins = pins;
    const Binding bound = bind(body, nullptr, garment);
    EXPECT_EQ(bound.skin.joints, joints);
    EXPECT_EQ(bound.attachment, pins);
}

TEST(Binder, RefusesUnfitGarments) {
    const BodySurface body(view_of(slim()));
    auto skirt = test::skirt_on(0.25f);
    skirt.triangles[3][1] = 1'000'000;
    EXPECT_THROW(static_cast<void>(bind(body, nullptr, view_of(skirt))), Error);
    skirt = test::skirt_on(0.25f);
    skirt.positions[5].x() = std::nanf("");
    EXPECT_THROW(static_cast<void>(bind(body, nullptr, view_of(skirt))), Error);
    skirt = {};
    EXPECT_THROW(static_cast<void>(bind(body, nullptr, view_of(skirt))), Error);
}

} // namespace
} // namespace toile::mesh_garment
