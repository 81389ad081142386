#include "simulated_sensor/camera_model.h"

#include "core/error.h"
#include "imaging/depth_noise.h"

#include <cmath>
#include <numbers>

namespace toile::simulated_sensor {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double focal(int pixels, double field_degrees) {
    return 0.5 * pixels / std::tan(0.5 * field_degrees * kDegree);
}

} // namespace

std::optional<CameraModel> camera_model_from_name(std::string_view name) {
    if (name == "kinect_v1") return CameraModel::kinect_v1;
    if (name == "kinect_v2") return CameraModel::kinect_v2;
    return std::nullopt;
}

NoiseSettings no_noise() {
    NoiseSettings out;
    out.axial = out.lateral = out.color = 0.0;
    out.quantisation = out.shadow = out.ragged = false;
    return out;
}

NoiseSettings usual_noise(CameraModel model) {
    NoiseSettings out;
    out.quantisation = out.shadow = model == CameraModel::kinect_v1; // v2 does not triangulate
    return out;
}

NoiseSettings full_noise(CameraModel model) {
    NoiseSettings out = usual_noise(model);
    out.correlated = true;
    out.depth_scale = 0.005;
    out.extrinsic_rotation = 0.2 * kDegree;
    out.extrinsic_translation_m = 0.005;
    return out;
}

imaging::Intrinsics CameraSettings::intrinsics() const {
    imaging::Intrinsics out;
    if (model == CameraModel::kinect_v1) {
        out.width = 640;
        out.height = 480;
        out.fx = focal(out.width, 57.0);
        out.fy = focal(out.height, 43.0);
    } else {
        out.width = 512;
        out.height = 424;
        out.fx = focal(out.width, 70.6);
        out.fy = focal(out.height, 60.0);
    }
    if (upright) {
        std::swap(out.width, out.height);
        std::swap(out.fx, out.fy);
    }
    out.cx = 0.5 * (out.width - 1);
    out.cy = 0.5 * (out.height - 1);
    return out;
}

double CameraSettings::baseline_focal() const {
    const imaging::Intrinsics in = intrinsics();
    return imaging::kKinectBaseline_m * (upright ? in.fy : in.fx);
}

CameraSettings camera_of(CameraModel model) {
    CameraSettings out;
    out.model = model;
    out.nearest_m = model == CameraModel::kinect_v1 ? 0.4 : 0.5;
    out.farthest_m = model == CameraModel::kinect_v1 ? 8.0 : 4.5;
    out.noise = usual_noise(model);
    return out;
}

Eigen::Isometry3d look_at(const Vec3d& position, const Vec3d& target, double roll) {
    const Vec3d back = position - target;
    const Vec3d right = Vec3d::UnitY().cross(back);
    if (!(right.norm() > 1e-6 * back.norm()) || !(back.norm() > 1e-6))
        throw Error("a camera cannot look straight up or down, nor at where it stands itself");
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear().col(0) = right.normalized();
    out.linear().col(2) = back.normalized();
    out.linear().col(1) = out.linear().col(2).cross(out.linear().col(0));
    out.translation() = position;
    out.rotate(Eigen::AngleAxisd(roll, Vec3d::UnitZ()));
    return out;
}

} // namespace toile::simulated_sensor
