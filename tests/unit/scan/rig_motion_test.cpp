#include "scan/rig_motion.h"

#include "core/error.h"
#include "core/random.h"

#include <gmock/gmock.h>
#include <numbers>

namespace toile::scan {
namespace {

using testing::HasSubstr;

Vec3d place(Random& random) {
    return {random.uniform(-0.7, 0.7), random.uniform(0.4, 1.6), random.uniform(-0.7, 0.7)};
}

/// Cameras around the origin that look at it, 2.4 m away.
std::vector<Pose> around(int count) {
    std::vector<Pose> out;
    for (int c = 0; c < count; ++c) {
        Pose pose = Pose::Identity();
        pose.rotate(Eigen::AngleAxisd(2.0 * std::numbers::pi * c / count, Vec3d::UnitY()));
        pose.translate(Vec3d(0.05 * c, 1.0, 2.4));
        out.push_back(pose);
    }
    return out;
}

/// sees(c, k): does camera c see place k?
template <class Sees>
SeenPlaces seen_by(const std::vector<Pose>& cameras, const std::vector<Vec3d>& places,
                   double noise_m, const Sees& sees) {
    Random random(9);
    SeenPlaces out(cameras.size());
    for (std::size_t c = 0; c < cameras.size(); ++c)
        for (std::size_t k = 0; k < places.size(); ++k) {
            auto& seen = out[c].emplace_back();
            const Vec3d noise(random.normal(), random.normal(), random.normal());
            if (sees(c, k))
                seen = SeenPlace{cameras[c].inverse() * places[k] + noise_m * noise, 0.002, 0.001};
        }
    return out;
}

std::vector<Vec3d> many(std::size_t count) {
    Random random(2);
    std::vector<Vec3d> out;
    for (std::size_t k = 0; k < count; ++k)
        out.push_back(place(random));
    return out;
}

const auto always = [](std::size_t, std::size_t) { return true; };

std::vector<std::string> names(std::size_t count) {
    std::vector<std::string> out;
    for (std::size_t c = 0; c < count; ++c)
        out.push_back("c" + std::to_string(c));
    return out;
}

std::string refusal(const SeenPlaces& seen) {
    try {
        (void)solve_rig(seen, names(seen.size()));
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(RigidMotion, IsFoundExactlyAndNeverMirrored) {
    const auto b = many(20);
    const Pose truth = around(5)[2];
    std::vector<Vec3d> a, flat_a, flat_b;
    for (const Vec3d& p : b) {
        a.push_back(truth * p);
        flat_b.emplace_back(p.x(), p.y(), 0.0); // in one plane a mirror image fits as well
        flat_a.push_back(truth * flat_b.back());
    }
    EXPECT_TRUE(rigid_motion(a, b).isApprox(truth, 1e-10));
    EXPECT_TRUE(rigid_motion(flat_a, flat_b).isApprox(truth, 1e-10));
}

TEST(RigidMotion, IsFoundAmongMostlyWrongPairs) {
    Random random(4);
    const Pose truth = around(7)[3];
    std::vector<Vec3d> a, b;
    for (int k = 0; k < 100; ++k) {
        b.push_back(place(random));
        a.push_back(k % 4 == 0 ? Vec3d(truth * b.back()) : truth * place(random));
    }
    const RigidFit fit = robust_motion(a, b, 0.02, 5000, 4);
    EXPECT_TRUE(fit.a_from_b.isApprox(truth, 1e-2));
    EXPECT_GE(fit.inliers.size(), 25u);
    EXPECT_LE(fit.inliers.size(), 30u);
}

TEST(Rig, FourCamerasAreFoundThroughTheirNeighbours) {
    const auto cameras = around(4);
    const auto places = many(60);
    // Opposite cameras never see the same: one side each, a quarter of them nobody but one.
    const auto sees = [&](std::size_t c, std::size_t k) { return k % 4 == c || (k + 1) % 4 == c; };
    const SeenPlaces exact = seen_by(cameras, places, 0.0, sees);
    const SolvedRig rig = solve_rig(exact, names(4));
    for (std::size_t c = 0; c < 4; ++c)
        EXPECT_TRUE(rig.first_from_camera[c].isApprox(cameras[0].inverse() * cameras[c], 1e-6));
    const SolvedRig noisy = solve_rig(seen_by(cameras, places, 0.002, sees), names(4));
    for (std::size_t c = 1; c < 4; ++c) {
        const Pose off = (cameras[0].inverse() * cameras[c]).inverse() * noisy.first_from_camera[c];
        EXPECT_LT(off.translation().norm(), 0.008) << c;
        EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.003) << c;
        EXPECT_LT(noisy.rms_m[c], 0.004);
    }
}

TEST(Rig, WrongSightingsAreLeftOut) {
    const auto cameras = around(2);
    SeenPlaces seen = seen_by(cameras, many(40), 0.0, always);
    for (std::size_t k = 0; k < 40; k += 4)
        seen[1][k]->point += Vec3d(0.3, -0.1, 0.2);
    const SolvedRig rig = solve_rig(seen, names(2));
    EXPECT_TRUE(rig.first_from_camera[1].isApprox(cameras[0].inverse() * cameras[1], 1e-6));
    EXPECT_EQ(rig.places[1], 30u);
}

TEST(Rig, SaysWhatIsMissing) {
    const auto cameras = around(3);
    const auto places = many(40);
    EXPECT_THAT(refusal(seen_by(cameras, places, 0.0,
                                [](std::size_t c, std::size_t k) { return c != 2 || k < 3; })),
                HasSubstr("camera 'c2' sees it in 3 pictures; at least 8"));
    EXPECT_THAT(refusal(seen_by(cameras, places, 0.0,
                                [](std::size_t c, std::size_t k) { return (c == 1) == (k > 20); })),
                HasSubstr("camera 'c1' never sees it at the same time"));
    std::vector<Vec3d> line;
    for (int k = 0; k < 30; ++k)
        line.emplace_back(-0.5 + 0.03 * k, 1.0 + 0.01 * k, 0.2);
    EXPECT_THAT(refusal(seen_by(cameras, line, 0.001, always)), HasSubstr("one straight line"));
    SeenPlaces loose = seen_by(cameras, places, 0.0, always);
    Random random(8);
    for (auto& seen : loose[1])
        seen->point = place(random);
    EXPECT_THAT(refusal(loose), HasSubstr("camera 'c1' and the others agree on fewer than 8"));
    EXPECT_THAT(refusal(SeenPlaces(1)), HasSubstr("a single camera"));
}

} // namespace
} // namespace toile::scan
