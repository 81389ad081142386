#include "scan/fusion.h"

#include "core/error.h"
#include "scan/subject.h"
#include "scan/tracking.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::scan {
namespace {

Vec3f middle_of(const DepthView& view) {
    Vec3d sum = Vec3d::Zero();
    double count = 0.0;
    for (int y = 0; y < view.camera.height; ++y)
        for (int x = 0; x < view.camera.width; ++x)
            if (view.depth[view.camera.at(x, y)] > 0.0f) {
                sum += view.point(x, y).cast<double>();
                count += 1.0;
            }
    if (count == 0.0) throw Error("a view of the subject holds no readings");
    return (sum / count).cast<float>();
}

Vec3d sight(const Pose& pose) {
    return pose.linear().col(2);
}

double angle_between(const Vec3d& a, const Vec3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// How far a motion takes the subject's own points, rms.
double distance_of(const Pose& motion, const DepthView& view, const Pose& pose) {
    double square = 0.0, count = 0.0;
    for (int y = 0; y < view.camera.height; y += 8)
        for (int x = 0; x < view.camera.width; x += 8)
            if (view.depth[view.camera.at(x, y)] > 0.0f) {
                const Vec3d p = pose * view.point(x, y).cast<double>();
                square += (motion * p - p).squaredNorm();
                count += 1.0;
            }
    return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

bool fits(const Registered& found) {
    return found.overlap >= kLeastOverlap && found.rms_m <= kMostRms_m;
}

} // namespace

RigidFusion::RigidFusion(const FusionOptions& options, RowLoop rows)
    : options_(options), rows_(std::move(rows)) {}
RigidFusion::~RigidFusion() = default;

void RigidFusion::begin(const DepthView& first) {
    model_ = std::make_unique<Volume>(Vec3f::Zero(), kTrackingVolume);
    first_.translation() = -middle_of(first).cast<double>();
}

void RigidFusion::keep(DepthView view, const Pose& pose, std::uint32_t number) {
    model_->integrate(view, pose, rows_);
    poses_.push_back(pose);
    views_.push_back(std::move(view));
    numbers_.push_back(number);
}

void RigidFusion::add_at(DepthView view, const Pose& first_from_camera) {
    if (!model_) begin(view);
    keep(std::move(view), first_ * first_from_camera, fed_++);
}

void RigidFusion::add(DepthView view, const std::optional<Pose>& likely) {
    const std::uint32_t number = fed_++;
    if (!model_) {
        begin(view);
        keep(std::move(view), first_, number);
        return;
    }
    Registered found = tracked(view);
    if (likely && !fits(found)) {
        found.pose = first_ * *likely;
        const Pose told = found.pose;
        for (const float reach : {0.1f, 0.04f})
            found = registered(view, found.pose, reach);
        // What it shows may not have been seen before.
        if (!fits(found) && can_have_turned_to(told, number))
            return keep(std::move(view), told, number);
    }
    if (fits(found))
        keep(std::move(view), found.pose, number);
    else
        ++report_.lost_frames;
}

/// No other turn than a slow one, from where the last view was.
bool RigidFusion::can_have_turned_to(const Pose& pose, std::uint32_t number) const {
    constexpr double kOnce_rad = 0.35, kEachView_rad = 0.2;
    const Eigen::AngleAxisd turn(pose.linear() * poses_.back().linear().transpose());
    return std::abs(turn.angle()) < kOnce_rad + kEachView_rad * (number - numbers_.back());
}

Registered RigidFusion::registered(const DepthView& view, const Pose& start, float reach) const {
    constexpr int kStride = 2;
    RegistrationOptions options;
    options.reach_m = reach;
    const SurfaceMap map = raycast(*model_, view, kStride, reach, start, rows_);
    return register_view(view, map, start, options, rows_);
}

/// Against the model, from where the motion would go on, or else from where the last view was.
Registered RigidFusion::tracked(const DepthView& view) const {
    const Pose& last = poses_.back();
    const Pose step =
        poses_.size() < 2 ? Pose::Identity() : last * poses_[poses_.size() - 2].inverse();
    return track_on(last, step,
                    [&](const Pose& start, float reach) { return registered(view, start, reach); });
}

std::vector<std::size_t> RigidFusion::all() const {
    std::vector<std::size_t> out(views_.size());
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
}

Volume RigidFusion::fused(std::span<const std::size_t> which, float voxel, float truncation) const {
    VolumeOptions options;
    options.voxel_m = voxel;
    options.truncation_m = truncation;
    Volume out(Vec3f::Zero(), options);
    for (const std::size_t i : which)
        out.integrate(views_[i], poses_[i], rows_);
    return out;
}

/// Mean motion that brings the views around `late` onto what the first views saw.
double RigidFusion::gap(std::size_t late, Pose& correction) const {
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < views_.size() / 3; ++i)
        if (angle_between(sight(poses_[i]), sight(poses_[0])) < 0.8) first.push_back(i);
    const Volume start = fused(first, kTrackingVolume.voxel_m, kTrackingVolume.truncation_m);
    Vec3d turn = Vec3d::Zero(), shift = Vec3d::Zero();
    int count = 0;
    for (std::size_t i = late < 3 ? 0 : late - 3; i <= std::min(late + 2, views_.size() - 1); ++i) {
        Registered found;
        found.pose = poses_[i];
        for (const float reach : {0.1f, 0.05f, 0.03f}) {
            RegistrationOptions options;
            options.reach_m = reach;
            const SurfaceMap map = raycast(start, views_[i], 2, reach, found.pose, rows_);
            found = register_view(views_[i], map, found.pose, options, rows_);
        }
        if (found.overlap < kLeastOverlap) continue;
        const Pose move = found.pose * poses_[i].inverse();
        const Eigen::AngleAxisd axis(move.linear());
        turn += axis.angle() * axis.axis();
        shift += move.translation();
        ++count;
    }
    correction = Pose::Identity();
    if (count == 0) return -1.0;
    turn /= count;
    if (turn.norm() > 1e-12)
        correction.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    correction.translation() = shift / count;
    return distance_of(correction, views_[late], poses_[late]);
}

void RigidFusion::close_loop() {
    constexpr double kComesRound = 4.7, kSameSide = 0.6; // radians
    double turned = 0.0;
    std::size_t late = 0;
    double nearest = kSameSide;
    for (std::size_t i = 1; i < poses_.size(); ++i) {
        turned += angle_between(sight(poses_[i]), sight(poses_[i - 1]));
        const double off = angle_between(sight(poses_[i]), sight(poses_[0]));
        if (turned > kComesRound && off < nearest) nearest = off, late = i;
    }
    report_.turn_rad = turned;
    if (late == 0 || !options_.close_loop) return;
    Pose correction;
    const double missed = gap(late, correction);
    if (missed < 0.0) return;
    report_.loop_closed = true;
    report_.loop_gap_m = missed;
    for (std::size_t i = 1; i < poses_.size(); ++i)
        poses_[i] = times_over(correction,
                               std::min(1.0, static_cast<double>(i) / static_cast<double>(late))) *
                    poses_[i];
    if (options_.refine_jointly) {
        for (const float reach : {0.03f, 0.02f}) {
            JointOptions joint;
            joint.reach_m = reach;
            const auto pairs = overlapping_pairs(poses_, options_.pair_angle, options_.pairs);
            report_.joint_rms_m = register_jointly(views_, pairs, joint, poses_, rows_);
        }
    }
    report_.loop_error_m = gap(late, correction);
}

/// Of the readings as they came, along the normals.
double RigidFusion::surface_rms(const Volume& volume) const {
    double square = 0.0, count = 0.0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
        const Eigen::Isometry3f pose = poses_[i].cast<float>();
        const DepthView& view = views_[i];
        for (int y = 0; y < view.camera.height; y += 4)
            for (int x = 0; x < view.camera.width; x += 4) {
                const std::size_t at = view.camera.at(x, y);
                if (view.weight[at] <= 0.0f) continue;
                const Vec3f ray = view.camera.ray(static_cast<float>(x), static_cast<float>(y));
                float distance = 0.0f;
                if (!volume.sample(pose * Vec3f(view.raw[at] * ray), distance)) continue;
                square += distance * distance;
                count += 1.0;
            }
    }
    return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

void RigidFusion::take_off_bias() {
    for (int round = 0; round < options_.bias_rounds && options_.filter.joint_bilateral; ++round) {
        const Volume volume = fused(all(), options_.voxel_m, options_.truncation_m);
        rows_(static_cast<std::uint32_t>(views_.size()), 1,
              [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t i = begin; i < end; ++i)
                      scan::take_off_bias(views_[i], predicted_depth(volume, views_[i], poses_[i]),
                                          options_.filter);
              });
    }
}

void RigidFusion::settle() {
    if (settled_) return;
    settled_ = true;
    model_.reset();
    report_.frames = views_.size();
    close_loop();
    if (report_.loop_closed || !options_.refine_jointly) return;
    const auto pairs = overlapping_pairs(poses_, options_.pair_angle, options_.pairs);
    report_.joint_rms_m = register_jointly(views_, pairs, {}, poses_, rows_);
}

std::map<std::uint32_t, Pose> RigidFusion::settled() {
    if (views_.size() > 1) settle();
    std::map<std::uint32_t, Pose> out;
    for (std::size_t i = 0; i < poses_.size(); ++i)
        out[numbers_[i]] = first_.inverse() * poses_[i];
    return out;
}

FusedSurface RigidFusion::finish(const std::optional<geometry::Plane>& floor,
                                 const std::function<void(double)>& progress) {
    if (fed_ == 0) throw Error("no frame shows anything to scan");
    if (views_.size() < 2 && report_.lost_frames > 0)
        throw Error(
            "none of the " + std::to_string(report_.lost_frames) +
            " frames after the first fits it: turn or move more slowly, let what is scanned "
            "keep still, and see that the camera reads most of it (not dark or shiny cloth "
            "or sunlight)");
    if (views_.size() < 2)
        throw Error("a single view shows one side only: move the camera around what is to be "
                    "scanned, or turn that slowly");
    settle();
    progress(0.5);
    take_off_bias();
    progress(0.7);
    const Volume volume = fused(all(), options_.voxel_m, options_.truncation_m);
    progress(0.8);
    const Pose out_of_scan = first_.inverse();
    std::optional<geometry::Plane> ground;
    if (floor) ground = moved(first_, *floor);
    std::vector<const DepthView*> views;
    for (const DepthView& view : views_)
        views.push_back(&view);
    const RigidPlaces places(poses_);
    ClosedSurface closed = closed_surface(volume, views, places, ground, nullptr, rows_);
    for (int round = 0; round < options_.smoothing_rounds; ++round)
        smooth(closed.mesh);
    FusedSurface out;
    out.colors = vertex_colors(closed.mesh, views, places, rows_);
    out.mesh = std::move(closed.mesh);
    move(out_of_scan, out.mesh);
    for (const Pose& pose : poses_)
        out.poses.push_back(out_of_scan * pose);
    out.frames = numbers_;
    report_.surface_rms_m = surface_rms(volume);
    report_.dropped_pieces = closed.dropped_pieces;
    report_.guessed_share = closed.guessed_share;
    out.report = report_;
    return out;
}

} // namespace toile::scan
