// Parts by eigenvectors: the same on one body in twenty poses, and on twenty bodies.
#include "body/spectral_parts.h"

#include "body/fit_model.h"
#include "body/usual_poses.h"
#include "core/random.h"
#include "geometry/laplacian.h"
#include "support/meshes.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <iostream>
#include <map>

namespace toile::body {
namespace {

constexpr double kLeastOverlap = 0.85;

const FitModel& adult() {
    static const FitModel kModel(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / "adult");
    return kModel;
}

geometry::TriangleMesh posed(const ShapeVector& coefficients, const Pose& pose) {
    PosedLevel out;
    pose_level(adult(), adult().level(0), {coefficients, {}}, pose, out);
    return {out.positions, {}, adult().level(0).triangles};
}

ShapeVector mean_shape() {
    return ShapeVector::Zero(adult().component_count());
}

Eigen::VectorXd areas() {
    const auto rest = posed(mean_shape(), {});
    return geometry::lumped_mass(rest.positions, rest.triangles);
}

const SpectralParts& rest_parts() {
    static const SpectralParts kParts = spectral_parts(posed(mean_shape(), {}));
    return kParts;
}

/// Arms in seven ways, legs in three.
std::vector<Pose> twenty_poses() {
    const Skeleton skeleton = adult().skeleton(mean_shape());
    std::vector<Pose> out;
    for (const ArmPose& arm : usual_arms())
        for (const std::size_t leg : {std::size_t{0}, std::size_t{1}, std::size_t{3}})
            out.push_back(
                with_leg(usual_pose(skeleton, arm, 0.0f), out.size() % 2 == 0, usual_legs()[leg]));
    out.resize(20);
    return out;
}

ShapeVector somebody(std::uint64_t seed) {
    Random random(seed);
    const CoefficientPrior& prior = adult().space().prior(kSexes[seed % 2]);
    ShapeVector normal(prior.mean.size());
    for (double& n : normal)
        n = random.normal();
    return prior.mean + prior.covariance.llt().matrixL() * normal;
}

TEST(SpectralParts, TheAbdomenIsTheSameInTwentyPoses) {
    double worst = 1.0;
    for (const Pose& pose : twenty_poses()) {
        const SpectralParts parts = spectral_parts(posed(mean_shape(), pose));
        worst = std::min(worst, overlap(parts.of, rest_parts().of, SpectralPart::abdomen, areas()));
        EXPECT_GT(worst, kLeastOverlap);
    }
    std::cout << "abdomen, 20 poses: overlap at least " << worst << "\n";
}

TEST(SpectralParts, TheAbdomenIsTheSameOnTwentyBodies) {
    double worst = 1.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const SpectralParts parts = spectral_parts(posed(somebody(seed), {}));
        worst = std::min(worst, overlap(parts.of, rest_parts().of, SpectralPart::abdomen, areas()));
        EXPECT_GT(worst, kLeastOverlap) << "seed " << seed;
    }
    std::cout << "abdomen, 20 bodies: overlap at least " << worst << "\n";
}

TEST(SpectralParts, ALargeScanHasTheSameParts) {
    auto fine = posed(mean_shape(), {});
    const std::size_t count = fine.positions.size();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    std::vector<Triangle> quarters;
    for (const Triangle& t : fine.triangles) {
        Triangle m{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            const auto [at, added] =
                middles.try_emplace({a, b}, static_cast<std::uint32_t>(fine.positions.size()));
            if (added) fine.positions.emplace_back(0.5f * (fine.positions[a] + fine.positions[b]));
            m[k] = at->second;
        }
        quarters.insert(quarters.end(),
                        {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, m});
    }
    fine.triangles = std::move(quarters);
    ASSERT_GT(fine.positions.size(), 40'000u); // enough to be taken together first
    SpectralParts parts = spectral_parts(fine);
    parts.of.resize(count);
    EXPECT_GT(overlap(parts.of, rest_parts().of, SpectralPart::abdomen, areas()), 0.95);
}

TEST(SpectralParts, PartsAreWhereTheyAreCalled) {
    const auto rest = posed(mean_shape(), {});
    const auto middle = [&](SpectralPart part) {
        Vec3f sum = Vec3f::Zero();
        float count = 0.0f;
        for (std::size_t v = 0; v < rest.positions.size(); ++v)
            if (rest_parts().of[v] == part) sum += rest.positions[v], count += 1.0f;
        EXPECT_GT(count, 100.0f);
        return Vec3f(sum / count);
    };
    EXPECT_GT(middle(SpectralPart::left_hand).x(), middle(SpectralPart::left_arm).x());
    EXPECT_GT(middle(SpectralPart::left_arm).x(), 0.1f);
    EXPECT_LT(middle(SpectralPart::right_hand).x(), middle(SpectralPart::right_arm).x());
    EXPECT_GT(middle(SpectralPart::left_foot).x(), 0.0f);
    EXPECT_LT(middle(SpectralPart::right_thigh).x(), 0.0f);
    EXPECT_LT(middle(SpectralPart::left_foot).y(), middle(SpectralPart::left_thigh).y());
    EXPECT_LT(middle(SpectralPart::left_thigh).y(), middle(SpectralPart::abdomen).y());
    EXPECT_LT(middle(SpectralPart::abdomen).y(), middle(SpectralPart::head_and_chest).y());
    EXPECT_LT(std::abs(middle(SpectralPart::abdomen).x()), 0.01f);
}

TEST(SpectralParts, WhatIsNoPersonIsRefused) {
    EXPECT_ERROR((void)spectral_parts(test::sphere(0.5f, 3)), "a person's parts");
}

} // namespace
} // namespace toile::body
