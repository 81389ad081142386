#include "fusion_scanner/fusion_session.h"

#include "core/error.h"
#include "scan/subject.h"

#include <numbers>

namespace toile::fusion_scanner {
namespace {

constexpr double kRough = 1.22; // times what a Kinect's readings are off a smooth surface
constexpr int kWideRadius = 6;  // pixels

double degrees(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

} // namespace

FusionSession::FusionSession(std::vector<SessionCamera> cameras, const SessionOptions& options,
                             RowLoop rows)
    : cameras_(std::move(cameras)), options_(options), rows_(std::move(rows)),
      waiting_(cameras_.size()) {
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
        imaging::check_intrinsics(cameras_[c].intrinsics);
        if (several() && !cameras_[c].world_from_camera)
            throw Error("camera " + std::to_string(c + 1) + " of " +
                        std::to_string(cameras_.size()) +
                        " does not know where it stands: find out with `toile scan --calibrate` "
                        "and give the result with --extrinsics");
    }
}

/// The world's up in a camera.
Vec3f FusionSession::up(std::size_t camera) const {
    const auto& place = cameras_[camera].world_from_camera;
    if (!place) return Vec3f::UnitY();
    return (place->linear().transpose() * Vec3d::UnitY()).cast<float>();
}

void FusionSession::add(std::span<const SessionPicture> instant) {
    ++fed_;
    std::vector<Seen> seen;
    bool waits = false;
    for (const SessionPicture& picture : instant) {
        std::optional<Seen> view;
        if (options_.averaged_frames <= 1) {
            view = use(picture);
        } else {
            auto& waiting = waiting_[picture.camera];
            waiting.emplace_back(picture.depth.begin(), picture.depth.end());
            if (waiting.size() < static_cast<std::size_t>(options_.averaged_frames)) {
                waits = true;
                continue;
            }
            const std::vector<float> mean = scan::averaged_depth(waiting);
            waiting.clear();
            view = use({picture.camera, mean, picture.color});
        }
        if (view) seen.push_back(std::move(*view));
    }
    if (!seen.empty())
        keep(std::move(seen));
    else if (!waits)
        ++empty_;
}

/// The subject in one picture; nothing, and why, when there is none.
std::optional<FusionSession::Seen> FusionSession::use(const SessionPicture& given) {
    const scan::Picture picture{cameras_[given.camera].intrinsics, given.depth, given.color};
    const scan::Subject subject = scan::find_subject(picture, up(given.camera));
    if (!subject.trouble.empty()) {
        trouble_ = subject.trouble;
        return std::nullopt;
    }
    scan::DepthView view = scan::filtered_view(picture, subject.mask, options_.filter, rows_);
    if (!begun_ && options_.choose_radius && scan::roughness(view) > kRough) {
        options_.filter.radius = kWideRadius;
        view = scan::filtered_view(picture, subject.mask, options_.filter, rows_);
    }
    begun_ = true;
    return Seen{{static_cast<std::uint32_t>(given.camera), std::move(view)}, subject.floor};
}

void FusionSession::keep(std::vector<Seen> instant) {
    if (!fusion_ && !rig_) {
        options_.fusion.filter = options_.filter;
        if (several()) {
            std::vector<scan::Pose> places;
            for (const SessionCamera& camera : cameras_)
                places.push_back(*camera.world_from_camera);
            rig_ = std::make_unique<scan::RigFusion>(options_.fusion, std::move(places), rows_);
        } else {
            fusion_ = std::make_unique<scan::RigidFusion>(options_.fusion, rows_);
            floor_ = instant.front().floor;
        }
    }
    if (fusion_) return fusion_->add(std::move(instant.front().view.view));
    std::vector<scan::CameraView> views;
    for (Seen& seen : instant) {
        if (!floor_ && seen.floor) {
            const Eigen::Isometry3f move =
                cameras_[seen.view.camera].world_from_camera->cast<float>();
            floor_ = geometry::Plane::through(move * Vec3f(seen.floor->offset * seen.floor->normal),
                                              move.linear() * seen.floor->normal);
        }
        views.push_back(std::move(seen.view));
    }
    rig_->add(std::move(views));
}

Eigen::Isometry3d FusionSession::upright(const geometry::TriangleMesh& mesh) const {
    if (cameras_[0].world_from_camera) return *cameras_[0].world_from_camera;
    const Vec3d above = (floor_ ? floor_->normal : up(0)).cast<double>();
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
    if (!fusion_ && !rig_)
        throw Error("nobody is in view in any of " + std::to_string(fed_) + " frames" +
                    (trouble_.empty() ? "" : ": " + trouble_));
    SessionResult out = fusion_ ? finish_one(progress) : finish_rig(progress);
    out.report["smoothing_radius"] = options_.filter.radius;
    out.report["floor"] = floor_.has_value();
    return out;
}

SessionResult FusionSession::finish_one(const std::function<void(double)>& progress) {
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
        {"turn_deg", degrees(r.turn_rad)},
        {"loop", {{"closed", r.loop_closed}, {"gap_m", r.loop_gap_m}, {"error_m", r.loop_error_m}}},
        {"views_rms_m", r.joint_rms_m},
        {"readings_rms_m", r.surface_rms_m},
        {"dropped_pieces", r.dropped_pieces},
        {"guessed_share", r.guessed_share}};
    return out;
}

SessionResult FusionSession::finish_rig(const std::function<void(double)>& progress) {
    if (options_.fusion.refine_jointly) rig_->place(options_.cameras);
    progress(0.4);
    scan::FusedSurface fused =
        rig_->finish(floor_, [&](double share) { progress(0.4 + 0.6 * share); });
    const scan::RigReport& r = rig_->report();
    SessionResult out{std::move(fused.mesh), std::move(fused.colors), {}};
    out.report = {{"cameras", cameras_.size()},
                  {"frames", r.instants},
                  {"frames_without_subject", empty_},
                  {"frames_lost", r.lost_instants},
                  {"turn_deg", degrees(r.turn_rad)},
                  {"cameras_moved_m", r.cameras_moved_m},
                  {"views_rms_m", r.views_rms_m},
                  {"readings_rms_m", fused.report.surface_rms_m},
                  {"dropped_pieces", fused.report.dropped_pieces},
                  {"guessed_share", fused.report.guessed_share}};
    return out;
}

} // namespace toile::fusion_scanner
