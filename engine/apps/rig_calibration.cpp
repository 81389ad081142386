#include "apps/rig_calibration.h"

#include "core/error.h"
#include "geometry/floor_plane.h"
#include "pipeline/body_fit.h"
#include "scan/ball_rig.h"
#include "scan/subject.h"
#include "scan/turn_rig.h"

#include <cstdio>
#include <numbers>
#include <unistd.h>

namespace toile::apps {
namespace {

using Instant = std::vector<pipeline::SensorFrame>;

void show(std::size_t count) {
    if (isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\r%zu frames", count);
}

std::vector<std::string> names_of(const CameraSet& cameras) {
    std::vector<std::string> out;
    for (const auto& stream : cameras.streams())
        out.push_back(stream.name);
    return out;
}

/// Upright with the floor at 0, as this picture of the camera has it; as it is when it sees none.
Eigen::Isometry3d upright(const pipeline::SensorStream& stream, const imaging::DepthImage& depth) {
    constexpr float kMostTilt = 0.5f;
    constexpr std::size_t kEnough = 4000;
    const imaging::DepthUnprojector unprojector(stream.depth);
    std::vector<Vec3f> points(depth.metres.size()), seen;
    unprojector.points(depth.metres, points);
    for (const Vec3f& p : points)
        if (p.allFinite() && p.z() < 0.0f) seen.push_back(p);
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    const auto thin = geometry::thinned_out(seen, kEnough);
    const auto floor = geometry::find_floor(thin, Vec3f::UnitY(), kMostTilt);
    if (!floor) return out;
    out.linear() = Eigen::Quaterniond::FromTwoVectors(floor->normal.cast<double>(), Vec3d::UnitY())
                       .toRotationMatrix();
    out.translation().y() = -floor->offset;
    return out;
}

imaging::RigFile ball_rig(CameraSet& cameras, const RigRequest& request) {
    const auto& streams = cameras.streams();
    scan::BallOptions options;
    options.radius_m = request.radius_m;
    scan::SeenBalls seen(streams.size());
    std::vector<double> focal;
    for (const auto& stream : streams)
        focal.push_back(stream.depth.fx);
    Instant instant, first;
    std::size_t count = 0;
    while ((request.frames == 0 || count < request.frames) && !host::interrupt_flag() &&
           cameras.next(instant)) {
        for (std::size_t c = 0; c < streams.size(); ++c)
            seen[c].push_back(scan::find_ball(streams[c].depth, instant[c].depth.metres, options));
        if (count++ == 0) first = instant;
        show(count);
    }
    if (count == 0) throw Error("the cameras gave no frame");
    const auto names = names_of(cameras);
    const scan::BallRig found = scan::rig_from_balls(seen, focal, names, request.radius_m);
    const Eigen::Isometry3d world =
        streams[0].world_from_camera.value_or(upright(streams[0], first[0].depth));
    imaging::RigFile out;
    out.method = request.method;
    out.report = {{"frames", count}, {"radius_m", found.radius_m}};
    for (std::size_t c = 0; c < streams.size(); ++c) {
        out.cameras.push_back({names[c], world * found.rig.first_from_camera[c]});
        out.report["cameras"].push_back(
            {{"name", names[c]}, {"places", found.rig.places[c]}, {"rms_m", found.rig.rms_m[c]}});
    }
    return out;
}

/// Instants spread over all that the cameras give, without colours.
std::vector<Instant> all_instants(CameraSet& cameras, std::uint32_t most) {
    constexpr std::size_t kMostKept = 80;
    std::vector<Instant> out;
    std::size_t every = 1, count = 0;
    Instant instant;
    while ((most == 0 || count < most) && !host::interrupt_flag() && cameras.next(instant)) {
        if (count % every == 0) {
            out.push_back(instant);
            for (pipeline::SensorFrame& frame : out.back())
                frame.color = {};
        }
        show(++count);
        if (out.size() <= kMostKept) continue;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < out.size(); i += 2)
            std::swap(out[kept++], out[i]);
        out.resize(kept);
        every *= 2;
    }
    if (out.empty()) throw Error("the cameras gave no frame");
    return out;
}

/// By a body fitted to what all see, at a few instants.
std::vector<scan::Pose> places_from_body(std::vector<pipeline::SensorStream> streams,
                                         const std::vector<Instant>& instants,
                                         host::Registry& registry, host::Services& services,
                                         const toile_limits& limits) {
    constexpr std::size_t kInstants = 4;
    for (std::size_t c = 0; c < streams.size(); ++c)
        streams[c].world_from_camera.reset();
    host::Job job({}, &host::interrupt_flag());
    pipeline::BodyFit fit(registry, services, limits);
    fit.begin_cameras(streams, job);
    const std::size_t used = std::min(kInstants, instants.size());
    for (std::size_t k = 0; k < used; ++k)
        fit.feed_frames(instants[k * instants.size() / used]);
    const pipeline::FittedBody body = fit.fit({}, job);
    std::vector<scan::Pose> out;
    for (const auto& camera : body.report.at("found_cameras")) {
        const auto numbers = camera.at("world_from_camera").get<std::vector<double>>();
        out.emplace_back(Eigen::Isometry3d(Eigen::Map<const Eigen::Matrix4d>(numbers.data())));
    }
    if (out.size() != streams.size()) throw Error("the fitted body does not place every camera");
    return out;
}

/// (instants) what each camera sees of the subject, from the first instant at which all see it.
using Seen = std::vector<std::vector<scan::CameraView>>;

Seen subjects(const std::vector<pipeline::SensorStream>& streams,
              const std::vector<Instant>& instants, const RowLoop& rows) {
    Seen out;
    for (const Instant& instant : instants) {
        std::vector<scan::CameraView> views;
        for (std::uint32_t c = 0; c < streams.size(); ++c) {
            const scan::Picture picture{streams[c].depth, instant[c].depth.metres, {}};
            const scan::Subject subject = scan::find_subject(picture, Vec3f::UnitY());
            if (subject.trouble.empty())
                views.push_back({c, scan::filtered_view(picture, subject.mask, {}, rows)});
        }
        if (!out.empty() || views.size() == streams.size()) out.push_back(std::move(views));
    }
    if (out.empty()) throw Error("at no time do all cameras see a person");
    return out;
}

/// By how the person turns before each camera; nothing when somebody stands still.
std::optional<std::vector<scan::Pose>>
places_from_turn(const Seen& seen, const std::vector<std::string>& names, const RowLoop& rows) {
    std::vector<scan::TurnTrack> tracks;
    for (std::uint32_t c = 0; c < names.size(); ++c) {
        std::vector<scan::DepthView> pictures;
        for (const auto& instant : seen)
            for (const scan::CameraView& view : instant)
                if (view.camera == c) pictures.push_back(view.view);
        tracks.push_back(scan::follow_turn(pictures, rows));
        if (c == 0 && tracks[0].turn_rad < scan::kLeastTurn_rad) return std::nullopt;
    }
    return scan::places_from_turns(tracks, names);
}

/// First roughly, then the surfaces that all cameras see are laid on each other.
imaging::RigFile person_rig(CameraSet& cameras, const RigRequest& request, host::Registry& registry,
                            host::Services& services, const toile_limits& limits) {
    const auto& streams = cameras.streams();
    const RowLoop rows = host::rows_of(services);
    const std::vector<Instant> instants = all_instants(cameras, request.frames);
    const std::vector<std::string> names = names_of(cameras);
    Seen seen = subjects(streams, instants, rows);
    const auto turned = places_from_turn(seen, names, rows);
    const auto rough =
        turned ? *turned : places_from_body(streams, instants, registry, services, limits);
    scan::RigFusion fusion({}, rough, rows);
    for (auto& instant : seen)
        fusion.add(std::move(instant));
    constexpr scan::CameraFreedom kFree{0.05, 0.1};
    fusion.place(kFree);
    const scan::RigReport& report = fusion.report();
    imaging::RigFile out;
    out.method = request.method;
    const Eigen::Isometry3d world =
        streams[0].world_from_camera.value_or(upright(streams[0], instants[0][0].depth)) *
        rough[0].inverse();
    for (std::size_t c = 0; c < streams.size(); ++c)
        out.cameras.push_back({names[c], world * fusion.world_from_camera()[c]});
    out.report = {{"instants", report.instants},
                  {"lost", report.lost_instants},
                  {"found_by", turned ? "turn" : "body"},
                  {"turn_deg", report.turn_rad * 180.0 / std::numbers::pi},
                  {"views_rms_m", report.views_rms_m},
                  {"moved_m", report.cameras_moved_m}};
    return out;
}

} // namespace

imaging::RigFile calibrate_rig(CameraSet& cameras, const RigRequest& request,
                               host::Registry& registry, host::Services& services,
                               const toile_limits& limits) {
    if (cameras.streams().size() < 2)
        throw UsageError("scan --calibrate: a single camera needs none; name more with --source");
    return request.method == "ball" ? ball_rig(cameras, request)
                                    : person_rig(cameras, request, registry, services, limits);
}

} // namespace toile::apps
