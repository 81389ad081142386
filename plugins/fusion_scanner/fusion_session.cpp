#include "fusion_scanner/fusion_session.h"

#include "core/error.h"
#include "scan/subject.h"

#include <algorithm>

namespace toile::fusion_scanner {
namespace {

constexpr double kRough = 1.22; // times what a Kinect's readings are off a smooth surface
constexpr int kWideRadius = 6;  // pixels

} // namespace

FusionSession::FusionSession(SessionCamera camera, const SessionOptions& options, RowLoop rows)
    : camera_(std::move(camera)), options_(options), rows_(std::move(rows)) {
    imaging::check_intrinsics(camera_.intrinsics);
}

/// The world's up in the camera.
Vec3f FusionSession::up() const {
    if (!camera_.world_from_camera) return Vec3f::UnitY();
    return (camera_.world_from_camera->linear().transpose() * Vec3d::UnitY()).cast<float>();
}

void FusionSession::add(std::span<const float> depth, std::span<const scan::Rgba8> color) {
    ++fed_;
    if (options_.averaged_frames <= 1) return use(depth, color);
    waiting_.emplace_back(depth.begin(), depth.end());
    if (waiting_.size() < static_cast<std::size_t>(options_.averaged_frames)) return;
    const std::vector<float> mean = scan::averaged_depth(waiting_);
    waiting_.clear();
    use(mean, color);
}

void FusionSession::use(std::span<const float> depth, std::span<const scan::Rgba8> color) {
    const scan::Picture picture{camera_.intrinsics, depth, color};
    const scan::Subject subject = scan::find_subject(picture, up());
    if (!subject.trouble.empty()) {
        ++empty_;
        trouble_ = subject.trouble;
        return;
    }
    scan::DepthView view = scan::filtered_view(picture, subject.mask, options_.filter, rows_);
    if (!fusion_) {
        if (options_.choose_radius && scan::roughness(view) > kRough) {
            options_.filter.radius = kWideRadius;
            view = scan::filtered_view(picture, subject.mask, options_.filter, rows_);
        }
        options_.fusion.filter = options_.filter;
        fusion_ = std::make_unique<scan::RigidFusion>(options_.fusion, rows_);
        floor_ = subject.floor;
    }
    fusion_->add(std::move(view));
}

Eigen::Isometry3d FusionSession::upright(const geometry::TriangleMesh& mesh) const {
    if (camera_.world_from_camera) return *camera_.world_from_camera;
    const Vec3d above = (floor_ ? floor_->normal : up()).cast<double>();
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond::FromTwoVectors(above, Vec3d::UnitY()).toRotationMatrix();
    Eigen::AlignedBox3d box;
    for (const Vec3f& p : mesh.positions)
        box.extend(out * p.cast<double>());
    out.translation() = -Vec3d(box.center().x(), box.min().y(), box.center().z());
    return out;
}

SessionResult FusionSession::finish(const std::function<void(double)>& progress) {
    if (fed_ == 0) throw Error("no frame was fed");
    if (!fusion_)
        throw Error("nobody is in view in any of " + std::to_string(fed_) + " frames" +
                    (trouble_.empty() ? "" : ": " + trouble_));
    scan::FusedSurface fused = fusion_->finish(floor_, progress);
    const Eigen::Isometry3f world = upright(fused.mesh).cast<float>();
    for (Vec3f& p : fused.mesh.positions)
        p = world * p;
    for (Vec3f& n : fused.mesh.normals)
        n = world.linear() * n;
    const scan::FusionReport& r = fused.report;
    SessionResult out{std::move(fused.mesh), std::move(fused.colors), {}};
    out.report = {
        {"frames", r.frames},
        {"frames_without_subject", empty_},
        {"frames_lost", r.lost_frames},
        {"turn_deg", r.turn_rad * 180.0 / 3.14159265358979},
        {"loop", {{"closed", r.loop_closed}, {"gap_m", r.loop_gap_m}, {"error_m", r.loop_error_m}}},
        {"smoothing_radius", options_.filter.radius},
        {"views_rms_m", r.joint_rms_m},
        {"readings_rms_m", r.surface_rms_m},
        {"floor", floor_.has_value()},
        {"dropped_pieces", r.dropped_pieces},
        {"guessed_share", r.guessed_share}};
    return out;
}

} // namespace toile::fusion_scanner
