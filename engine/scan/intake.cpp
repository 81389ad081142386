#include "scan/intake.h"

namespace toile::scan {
namespace {

constexpr double kRough = 1.22; // times what a Kinect's readings are off a smooth surface
constexpr int kWideRadius = 6;  // pixels

} // namespace

Intake::Intake(IntakeCamera camera, const FilterOptions& filter, bool choose_radius, RowLoop rows)
    : camera_(std::move(camera)), filter_(filter), choose_radius_(choose_radius),
      rows_(std::move(rows)) {
    imaging::check_intrinsics(camera_.intrinsics);
}

/// The world's up in the camera.
Vec3f Intake::up() const {
    if (!camera_.world_from_camera) return Vec3f::UnitY();
    return (camera_.world_from_camera->linear().transpose() * Vec3d::UnitY()).cast<float>();
}

std::optional<DepthView> Intake::view(std::span<const float> depth, std::span<const Rgba8> color) {
    ++fed_;
    const Picture picture{camera_.intrinsics, depth, color};
    const Subject subject = find_subject(picture, up());
    if (!subject.trouble.empty()) {
        ++empty_;
        trouble_ = subject.trouble;
        return std::nullopt;
    }
    DepthView out = filtered_view(picture, subject.mask, filter_, rows_);
    last_floor_ = subject.floor;
    if (fed_ - passed_ - empty_ > 1) return out;
    floor_ = subject.floor;
    if (!choose_radius_ || !(roughness(out) > kRough)) return out;
    filter_.radius = kWideRadius;
    return filtered_view(picture, subject.mask, filter_, rows_);
}

Eigen::Isometry3d Intake::upright(const geometry::TriangleMesh& surface) const {
    if (camera_.world_from_camera) return *camera_.world_from_camera;
    const Vec3d above = (floor_ ? floor_->normal : up()).cast<double>();
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond::FromTwoVectors(above, Vec3d::UnitY()).toRotationMatrix();
    Eigen::AlignedBox3d box;
    for (const Vec3f& p : surface.positions)
        box.extend(out * p.cast<double>());
    out.translation() = -Vec3d(box.center().x(), box.min().y(), box.center().z());
    return out;
}

} // namespace toile::scan
