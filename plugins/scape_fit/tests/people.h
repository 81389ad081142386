// A person of the body space to be found again, and what scanners do to one.
#pragma once

#include "body/joint_limits.h"
#include "body/rotations.h"
#include "core/paths.h"
#include "scape_fit/fit_session.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

namespace toile::scape_fit {

/// Loaded once for all tests of a program.
inline const FitModel& adult() {
    static const FitModel model(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / "adult");
    return model;
}

/// Somebody of the women's population, arms lowered a little, one elbow bent.
struct Somebody {
    FitShape shape;
    body::Pose pose;
    geometry::TriangleMesh surface;

    explicit Somebody(std::uint64_t seed = 5) {
        Random random(seed);
        const body::CoefficientPrior& prior = adult().space().prior(body::Sex::female);
        Eigen::VectorXd normal(prior.mean.size());
        for (double& n : normal)
            n = random.normal();
        shape.coefficients = prior.mean + prior.covariance.llt().matrixL() * normal;
        const body::Skeleton skeleton = adult().skeleton(shape.coefficients);
        pose.hips_position = Vec3f(0.1f, 0.95f, -0.2f);
        const auto turn = [&](body::Joint joint, const Vec3f& share) {
            pose.rotations[static_cast<std::size_t>(joint)] =
                body::from_rotation_vector(body::limited_rotation(skeleton, joint, share));
        };
        turn(body::Joint::left_upper_arm, Vec3f(0.0f, 0.1f, -0.5f));
        turn(body::Joint::right_upper_arm, Vec3f(0.0f, 0.1f, -0.3f));
        turn(body::Joint::right_lower_arm, Vec3f(0.0f, 0.3f, 0.0f));
        turn(body::Joint::left_upper_leg, Vec3f(-0.05f, 0.0f, 0.1f));
        PosedLevel posed;
        pose_level(adult(), adult().level(0), shape, pose, posed);
        surface.positions = posed.positions;
        surface.triangles = adult().level(0).triangles;
        float low = 1e9f;
        for (const Vec3f& p : surface.positions)
            low = std::min(low, p.y());
        for (Vec3f& p : surface.positions)
            p.y() -= low;
        pose.hips_position.y() -= low;
    }
};

/// Mean distance of a surface's vertices from another surface, metres.
inline double mean_distance(std::span<const Vec3f> from, const geometry::TriangleMesh& to) {
    const geometry::NearestSurface surface(to.positions, to.triangles);
    double sum = 0.0;
    for (const Vec3f& p : from)
        sum += static_cast<double>(surface.nearest(p).distance);
    return sum / static_cast<double>(from.size());
}

inline geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Mat3f& turn,
                                    float scale = 1.0f, const Vec3f& shift = Vec3f::Zero()) {
    for (Vec3f& p : mesh.positions)
        p = scale * (turn * p) + shift;
    return mesh;
}

inline void add(geometry::TriangleMesh& to, const geometry::TriangleMesh& what) {
    const auto base = static_cast<std::uint32_t>(to.positions.size());
    to.positions.insert(to.positions.end(), what.positions.begin(), what.positions.end());
    for (const Triangle& t : what.triangles)
        to.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

} // namespace toile::scape_fit
