#include "scan/warp_session.h"

#include "core/error.h"
#include "geometry/decimate.h"

#include <algorithm>

namespace toile::scan {
namespace {

constexpr std::size_t kTemplateVertices = 3000; // of a template of our own
constexpr double kMostAstray_m = 0.08; // mean: of a body beside where the trunk was tracked

nlohmann::ordered_json told(const WarpFusionReport& r) {
    nlohmann::ordered_json rounds = nlohmann::ordered_json::array();
    for (const JointWarpRound& round : r.rounds)
        rounds.push_back(round.rms_m);
    nlohmann::ordered_json out;
    if (!r.residuals_m.empty()) {
        out["residuals_m"] = r.residuals_m;
        out["parts_left_out"] = r.parts_left_out;
    }
    out.update({{"rounds_rms_m", rounds},
                {"views_rms_m", r.rounds.empty() ? 0.0 : r.rounds.back().rms_m},
                {"overlap", r.rounds.empty() ? 0.0 : r.rounds.back().overlap},
                {"loop", {{"gap_m", r.loop_gap_m}, {"error_m", r.loop_error_m}}},
                {"limbs_astray", r.limbs_astray},
                {"beside_share", r.beside_share},
                {"carried_left_out", r.carried_left_out},
                {"bound_share", r.bound_share},
                {"largest_move_m", r.largest_move_m},
                {"readings_rms_m", r.surface_rms_m},
                {"template_off_m", r.template_off_m},
                {"dropped_pieces", r.dropped_pieces},
                {"guessed_share", r.guessed_share}});
    return out;
}

/// Of the plugin boundary's label (abi/body.h, P4's 12 parts).
BodyGroup group_of(std::uint8_t label) {
    constexpr std::array<BodyGroup, 13> kGroups{
        BodyGroup::trunk, // no label
        BodyGroup::head,
        BodyGroup::trunk,
        BodyGroup::left_upper_arm,
        BodyGroup::left_lower_arm,
        BodyGroup::right_upper_arm,
        BodyGroup::right_lower_arm,
        BodyGroup::left_upper_leg,
        BodyGroup::left_lower_leg,
        BodyGroup::right_upper_leg,
        BodyGroup::right_lower_leg,
        BodyGroup::trunk, // the pelvis
        BodyGroup::head,  // the neck
    };
    if (label >= kGroups.size())
        throw Error("the body's part label " + std::to_string(label) + " is none");
    return kGroups[label];
}

} // namespace

WarpSession::WarpSession(IntakeCamera camera, const WarpSessionOptions& options, RowLoop rows)
    : options_(options), rows_(std::move(rows)),
      subject_(std::move(camera), options.subject, rows_) {}

FusionOptions WarpSession::rough() const {
    FusionOptions out;
    out.filter = subject_.intake().filter();
    out.voxel_m = 0.01f;
    out.truncation_m = 0.03f;
    out.bias_rounds = 0;
    return out;
}

/// Without a body: what the frames look like, were the person stiff.
MovingTemplate WarpSession::stiff_template(nlohmann::ordered_json& report) const {
    RigidFusion fusion(rough(), rows_);
    for (const NumberedView& view : subject_.views())
        fusion.add(view.view);
    const FusedSurface fused = fusion.finish(subject_.intake().floor(), [](double) {});
    const geometry::Decimation coarse = geometry::decimate(fused.mesh, kTemplateVertices);
    MovingTemplate out;
    for (const std::uint32_t v : coarse.vertices)
        out.shape.positions.push_back(fused.mesh.positions[v]);
    out.shape.triangles = coarse.triangles;
    for (std::size_t i = 0; i < fused.poses.size(); ++i) {
        const Eigen::Isometry3f back = fused.poses[i].inverse().cast<float>();
        std::vector<Vec3f> places;
        for (const Vec3f& p : out.shape.positions)
            places.push_back(back * p);
        out.poses[subject_.views()[fused.frames[i]].number] = std::move(places);
    }
    report["frames_lost"] = fused.report.lost_frames;
    return out;
}

/// The body, where it stood as the trunk did: at some instants left and right, or front and back,
/// may have been mistaken.
MovingTemplate WarpSession::body_template(nlohmann::ordered_json& report) const {
    MovingTemplate out{subject_.shape(), subject_.poses(), {}};
    RigidFusion fusion(rough(), rows_);
    const std::vector<Vec3f> first = out.poses.begin()->second;
    WholeMotion fitted;
    for (const auto& [number, positions] : out.poses)
        fitted[number] = whole_motion(positions, first);
    Vec3d middle = Vec3d::Zero();
    for (const Vec3f& p : first)
        middle += p.cast<double>() / static_cast<double>(first.size());
    std::vector<std::uint32_t> numbers;
    for (const NumberedView& view : subject_.views()) {
        if (view.number < out.poses.begin()->first) continue;
        numbers.push_back(view.number);
        fusion.add(view.view, turned_evenly(fitted, view.number, middle));
    }
    for (const auto& [at, pose] : fusion.settled())
        out.whole[numbers[at]] = pose;
    report["frames_lost"] = numbers.size() - out.whole.size();
    std::erase_if(out.poses, [&](const auto& instant) {
        const auto known = out.whole.find(instant.first);
        if (known == out.whole.end()) return false;
        const Pose& told = fitted.at(instant.first);
        double off = 0.0;
        for (const Vec3f& p : instant.second)
            off += (told * p.cast<double>() - known->second * p.cast<double>()).norm();
        return off > kMostAstray_m * static_cast<double>(first.size());
    });
    report["template_refused"] = subject_.poses().size() - out.poses.size();
    return out;
}

WarpSessionResult WarpSession::finish(const std::function<void(double)>& progress) {
    subject_.check();
    const Intake& intake = subject_.intake();
    WarpSessionResult out;
    out.report = {{"frames", subject_.views().size()},
                  {"frames_without_subject", intake.empty()},
                  {"template", subject_.guided() ? "body" : "what kept still"}};
    const MovingTemplate body =
        subject_.guided() ? body_template(out.report) : stiff_template(out.report);
    out.report["template_instants"] = body.poses.size();
    progress(0.2);
    options_.warp.filter = intake.filter();
    if (options_.by_parts && subject_.guided())
        for (const std::uint8_t label : subject_.labels())
            options_.parts.groups.push_back(group_of(label));
    WarpedSurface warped = fuse_warped(subject_.take_views(), body, intake.floor(), options_.warp,
                                       options_.parts, rows_, progress);
    move(intake.upright(warped.mesh), warped.mesh);
    out.mesh = std::move(warped.mesh);
    out.colors = std::move(warped.colors);
    out.report["smoothing_radius"] = intake.filter().radius;
    out.report["floor"] = intake.floor().has_value();
    out.report.update(told(warped.report));
    return out;
}

} // namespace toile::scan
