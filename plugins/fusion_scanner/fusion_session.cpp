#include "fusion_scanner/fusion_session.h"

#include "core/error.h"

#include <numbers>

namespace toile::fusion_scanner {
namespace {

double degrees(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

} // namespace

FusionSession::FusionSession(std::vector<scan::IntakeCamera> cameras, const SessionOptions& options,
                             RowLoop rows)
    : options_(options), rows_(std::move(rows)), waiting_(cameras.size()) {
    for (std::size_t c = 0; c < cameras.size(); ++c) {
        if (cameras.size() > 1 && !cameras[c].world_from_camera)
            throw Error("camera " + std::to_string(c + 1) + " of " +
                        std::to_string(cameras.size()) +
                        " does not know where it stands: find out with `toile scan --calibrate` "
                        "and give the result with --extrinsics");
        cameras_.emplace_back(std::move(cameras[c]), options_.filter, options_.choose_radius,
                              rows_);
    }
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

/// The subject in one picture; nothing, and why, when there is none. All filter as the first view
/// asks for.
std::optional<FusionSession::Seen> FusionSession::use(const SessionPicture& given) {
    scan::Intake& camera = cameras_[given.camera];
    auto view = camera.view(given.depth, given.color);
    if (!view) {
        trouble_ = camera.trouble();
        return std::nullopt;
    }
    if (!begun_) {
        for (scan::Intake& other : cameras_)
            other.filter_as(camera);
        options_.fusion.filter = camera.filter();
    }
    begun_ = true;
    return Seen{{static_cast<std::uint32_t>(given.camera), std::move(*view)}, camera.last_floor()};
}

void FusionSession::keep(std::vector<Seen> instant) {
    if (!fusion_ && !rig_) {
        if (several()) {
            std::vector<scan::Pose> places;
            for (const scan::Intake& camera : cameras_)
                places.push_back(*camera.camera().world_from_camera);
            rig_ = std::make_unique<scan::RigFusion>(options_.fusion, std::move(places), rows_);
        } else {
            fusion_ = std::make_unique<scan::RigidFusion>(options_.fusion, rows_);
            floor_ = instant.front().floor;
        }
    }
    if (fusion_) return fusion_->add(std::move(instant.front().view.view));
    std::vector<scan::CameraView> views;
    for (Seen& seen : instant) {
        if (!floor_ && seen.floor)
            floor_ =
                scan::moved(*cameras_[seen.view.camera].camera().world_from_camera, *seen.floor);
        views.push_back(std::move(seen.view));
    }
    rig_->add(std::move(views));
}

SessionResult FusionSession::finish(const std::function<void(double)>& progress) {
    if (fed_ == 0) throw Error("no frame was fed");
    if (!fusion_ && !rig_)
        throw Error("nobody is in view in any of " + std::to_string(fed_) + " frames" +
                    (trouble_.empty() ? "" : ": " + trouble_));
    SessionResult out = fusion_ ? finish_one(progress) : finish_rig(progress);
    out.report["smoothing_radius"] = options_.fusion.filter.radius;
    out.report["floor"] = floor_.has_value();
    return out;
}

SessionResult FusionSession::finish_one(const std::function<void(double)>& progress) {
    scan::FusedSurface fused = fusion_->finish(floor_, progress);
    scan::move(cameras_[0].upright(fused.mesh), fused.mesh);
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
