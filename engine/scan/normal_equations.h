// What registrations share: point-to-plane pairs summed to a system of six unknowns.
#pragma once

#include "scan/registration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace toile::scan {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A small motion: rotation vector, then translation.
inline Pose motion(const Vector6& step) {
    Pose out = Pose::Identity();
    const Vec3d turn = step.head<3>();
    const double angle = turn.norm();
    if (angle > 1e-12) out.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    out.translation() = step.tail<3>();
    return out;
}

/// The same about a point that is not the origin.
inline Pose motion_about(const Vec3d& about, const Vector6& step) {
    Pose out = motion(step);
    out.translation() += about - out.linear() * about;
    return out;
}

/// `move` after `pose`, kept rigid: rounding would double with every prediction from a prediction.
inline Pose moved(const Pose& move, const Pose& pose) {
    Pose out = move * pose;
    out.linear() = Eigen::Quaterniond(out.linear()).normalized().toRotationMatrix();
    return out;
}

/// Sums of one system, of one range of rows.
struct Sums {
    Matrix6 h = Matrix6::Zero();
    Vector6 g = Vector6::Zero();
    double square = 0.0, weight = 0.0;
    std::size_t pairs = 0, readings = 0;

    /// Residual normal . (motion(q) - target), Huber-weighted.
    void add(const Vec3f& q, const Vec3f& normal, double residual, double weight_at, double huber) {
        const double w = weight_at * std::min(1.0, huber / std::max(1e-12, std::abs(residual)));
        Vector6 row;
        row << q.cross(normal).cast<double>(), normal.cast<double>();
        h += w * row * row.transpose();
        g += w * residual * row;
        square += w * residual * residual;
        weight += w;
        ++pairs;
    }
    Sums& operator+=(const Sums& b) {
        h += b.h, g += b.g, square += b.square, weight += b.weight;
        pairs += b.pairs, readings += b.readings;
        return *this;
    }
};

/// Least squares step about a point amid the readings; directions that nothing holds stay zero.
inline Vector6 solved(const Matrix6& h, const Vector6& g) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(h);
    const double least = 1e-6 * eigen.eigenvalues().maxCoeff();
    Vector6 out = Vector6::Zero();
    for (int k = 0; k < 6; ++k)
        if (eigen.eigenvalues()[k] > least && eigen.eigenvalues()[k] > 0.0)
            out -= eigen.eigenvectors().col(k) *
                   (eigen.eigenvectors().col(k).dot(g) / eigen.eigenvalues()[k]);
    return out;
}

/// Pairs of two views that see the same places, each reading on the other's tangent plane. The
/// system is that of a motion of `a` (scan's coordinates); that of `b` is its negative.
[[nodiscard]] Sums mutual_sums(const DepthView& a, const DepthView& b, const Pose& scan_a,
                               const Pose& scan_b, const JointOptions& options);

} // namespace toile::scan
