#include "body/pose_prior.h"

#include "body/joint_limits.h"
#include "body/rotations.h"

#include <Eigen/LU>
#include <algorithm>

namespace toile::body {
namespace {

constexpr double kBeyondLimit = 2.0 * M_PI / 180.0; // radians: deviation past a joint's limit
constexpr double kLeastRange = 4.0 * M_PI / 180.0;

Eigen::Matrix3d cross_matrix(const Vec3d& v) {
    Eigen::Matrix3d m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
}

/// How a rotation vector changes when a small turn goes before the rotation.
Eigen::Matrix3d log_derivative(const Vec3d& r) {
    const double angle = r.norm();
    const Eigen::Matrix3d cross = cross_matrix(r);
    const double factor =
        angle < 1e-3
            ? 1.0 / 12.0
            : 1.0 / (angle * angle) - (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
    return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}

} // namespace

PosePrior::PosePrior(const Skeleton& skeleton) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto joint = static_cast<Joint>(j);
        const JointLimits limits = joint_limits(joint);
        Mat3f axes = Mat3f::Identity();
        for (int k = 0; k < 3; ++k) {
            const AngleRange& range = limits.range[static_cast<std::size_t>(k)];
            ranges_[j][static_cast<std::size_t>(k)] = {
                range.low, range.high,
                std::max(kLeastRange, 0.5 * (static_cast<double>(range.high) - range.low))};
            if (range.high > 0.0f)
                axes.col(k) = limited_rotation(skeleton, joint, Vec3f::Unit(k)) / range.high;
        }
        into_axes_[j] = axes.cast<double>().inverse();
    }
}

void PosePrior::add(const Pose& pose, double weight, int at, Eigen::MatrixXd& normal,
                    Eigen::VectorXd& gradient) const noexcept {
    for (std::size_t j = 1; j < kJointCount; ++j) {
        const Vec3d turn = rotation_vector(pose.rotations[j]).cast<double>();
        const Eigen::Matrix3d derivative = into_axes_[j] * log_derivative(turn);
        const Vec3d angle = into_axes_[j] * turn;
        const int place = at + 3 + 3 * static_cast<int>(j);
        for (int a = 0; a < 3; ++a) {
            const Axis& axis = ranges_[j][static_cast<std::size_t>(a)];
            double stiffness = weight / (axis.half * axis.half);
            double pull = stiffness * angle[a];
            const double beyond = angle[a] - std::clamp(angle[a], axis.low, axis.high);
            if (beyond != 0.0) {
                const double hard = 1.0 / (kBeyondLimit * kBeyondLimit);
                stiffness += hard;
                pull += hard * beyond;
            }
            const Eigen::RowVector3d row = derivative.row(a);
            normal.block<3, 3>(place, place) += stiffness * row.transpose() * row;
            gradient.segment<3>(place) += pull * row.transpose();
        }
    }
}

} // namespace toile::body
