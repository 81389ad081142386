#include "scape_fit/camera_correction.h"

namespace toile::scape_fit {

Eigen::Matrix3d rotation_of(const Vec3d& turn) {
    const double angle = turn.norm();
    if (angle < 1e-12) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

Vec3f CameraCorrection::apply(const Vec3f& point, const Vec3f& place) const {
    const Vec3d local = (point - place).cast<double>();
    return place + (shift + rotation_of(turn) * (scale * local)).cast<float>();
}

Vec3f CameraCorrection::undo(const Vec3f& point, const Vec3f& place) const {
    const Vec3d local = (point - place).cast<double>() - shift;
    return place + (rotation_of(turn).transpose() * local / scale).cast<float>();
}

} // namespace toile::scape_fit
