#include "body_tracker/pose_search.h"

#include "body/rotations.h"
#include "body/usual_poses.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

using body::Joint;

constexpr int kYaws = 12;
constexpr std::size_t kKept = 4;    // candidates of the library
constexpr std::size_t kLimbs = 3;   // whose limbs are tried one by one
constexpr std::size_t kRefined = 2; // and that are moved on to the end
constexpr int kQuickRounds = 3;
constexpr int kArmRounds = 5;
constexpr float kWorthMoving =
    0.02f; // badness that an arm not moved onto the picture may have more
constexpr float kArmBetter = 0.035f;
constexpr int kRounds = 8;
constexpr float kPartsWeight = 0.5f; // of what the forest says
constexpr float kSeesFaces = 0.05f;  // half of how much more readily it takes a person to face it
constexpr float kStands = 0.25f, kWalks = 0.6f; // m/s: less is no walking, more says no more
constexpr float kBackwards = 0.15f;             // badness of a m/s beyond that
constexpr float kThickness = 0.10f;             // metres from the seen surface to the body's middle
constexpr float kHeadTops = 2.1f;               // the crown is so many necks above the head's joint

RegistrationOptions wide_options() {
    RegistrationOptions out;
    out.reach_m = 0.25f;
    out.robust_m = 0.10f;
    out.extra_reach_m = 0.6f;
    out.outline_reach_m = 0.6f;
    out.damping = 0.05;
    return out;
}

/// What is seen of somebody: the middle, and how high it reaches.
struct Extent {
    Vec3f middle = Vec3f::Zero();
    float high = -1e9f; ///< along up
    bool cut = false;   ///< by the picture's upper border
};

Extent extent_of(const SeenPerson& seen, const Vec3f& up) noexcept {
    const GridCamera& camera = seen.grid.camera;
    Extent out;
    float count = 0.0f;
    for (int y = seen.mask.low[1]; y <= seen.mask.high[1]; ++y)
        for (int x = seen.mask.low[0]; x <= seen.mask.high[0]; ++x) {
            const auto i = static_cast<std::size_t>(y * camera.width + x);
            if (seen.mask.cells[i] == 0) continue;
            const Vec3f p =
                camera.point(static_cast<float>(x), static_cast<float>(y), seen.grid.depth[i]);
            out.high = std::max(out.high, up.dot(p));
            out.middle += p;
            count += 1.0f;
        }
    out.middle /= std::max(1.0f, count);
    out.cut = seen.mask.low[1] <= 1;
    return out;
}

} // namespace

PoseSearch::PoseSearch(const TrackedBody& body, PartsView& parts, const GridCamera& camera)
    : body_(body), parts_(parts), aim_(camera) {
    const body::Skeleton& skeleton = body.model().space().model().skeleton;
    for (const auto arms : {body::usual_arms(), body::single_arms()})
        for (const body::ArmPose& arm : arms)
            arms_.push_back(body::usual_pose(skeleton, arm, 0.0f));
    best_.reserve(kKept + 1);
}

std::optional<float> PoseSearch::height_of(const SeenPerson& seen, const Vec3f& up) noexcept {
    const Extent extent = extent_of(seen, up);
    if (!seen.floor || extent.cut) return std::nullopt;
    return extent.high - seen.floor->offset;
}

/// Beneath the top of the head; when that is not in view, as high above the floor as when standing.
Vec3f PoseSearch::hips_place(const SeenPerson& seen, const Vec3f& up) const noexcept {
    const Extent extent = extent_of(seen, up);
    const body::Skeleton& skeleton = body_.skeleton();
    const float hips = skeleton.rest(Joint::hips).y(), neck = skeleton.rest(Joint::neck).y();
    const float crown = neck + kHeadTops * (skeleton.rest(Joint::head).y() - neck);
    const Vec3f away = body::unit_or(extent.middle - up.dot(extent.middle) * up, -Vec3f::UnitZ());
    const Vec3f foot = extent.middle - up.dot(extent.middle) * up + kThickness * away;
    const float sole =
        std::min(skeleton.rest(Joint::left_toes).y(), skeleton.rest(Joint::right_toes).y());
    const float height =
        extent.cut && seen.floor ? seen.floor->offset + hips - sole : extent.high - (crown - hips);
    return foot + height * up;
}

body::Pose PoseSearch::turned_around(const body::Pose& pose) noexcept {
    body::Pose out = pose;
    for (std::size_t j = 1; j < body::kJointCount; ++j) {
        const Quatf& q = pose.rotations[j];
        out.rotations[static_cast<std::size_t>(body::opposite_joint(static_cast<Joint>(j)))] =
            Quatf(q.w(), -q.x(), q.y(), -q.z());
    }
    out.rotations[0] = pose.rotations[0] * body::about(Vec3f::UnitY(), body::kPi);
    return out;
}

float PoseSearch::rate(const SeenPerson& seen, const body::Pose& pose, Registration& registration,
                       bool whole) const noexcept {
    const float backwards = -drift_.dot(pose.rotations[0] * Vec3f::UnitZ());
    const float odd = kBackwards * std::clamp(backwards - kStands, 0.0f, kWalks);
    const Agreement agreement = registration.judge(seen, pose, whole);
    if (!parts_.useful()) return agreement.badness() + odd;
    const Vec3f to_camera = body::unit_or(-pose.hips_position, Vec3f::UnitZ());
    const float facing = to_camera.dot(pose.rotations[0] * Vec3f::UnitZ());
    const float support = parts_.support(registration.drawing()) - kSeesFaces * facing;
    return agreement.badness() + odd - kPartsWeight * support;
}

void PoseSearch::keep(const SeenPerson& seen, const body::Pose& pose,
                      Registration& registration) noexcept {
    const Candidate candidate{pose, rate(seen, pose, registration, false)};
    if (best_.size() == kKept && candidate.badness >= best_.back().badness) return;
    const auto at = std::upper_bound(
        best_.begin(), best_.end(), candidate,
        [](const Candidate& a, const Candidate& b) { return a.badness < b.badness; });
    best_.insert(at, candidate);
    if (best_.size() > kKept) best_.pop_back();
}

void PoseSearch::improve_limbs(const SeenPerson& seen, Candidate& candidate,
                               Registration& registration) noexcept {
    const auto offer = [&](const body::Pose& pose) {
        const float badness = rate(seen, pose, registration, false);
        if (badness < candidate.badness) candidate = {pose, badness};
    };
    for (const bool left : {true, false})
        for (const body::Pose& arms : arms_)
            offer(body::with_arm(candidate.pose, left, arms));
    for (const bool left : {true, false}) {
        (void)rate(seen, candidate.pose, registration, false);
        for (const body::Pose& pose : aim_.reach(seen, body_, registration, candidate.pose, left))
            offer(pose);
    }
    for (const bool left : {true, false})
        for (const body::LegPose& leg : body::usual_legs())
            offer(body::with_leg(candidate.pose, left, leg));
}

bool PoseSearch::retry_arm(const SeenPerson& seen, bool left, const RegistrationOptions& options,
                           body::Pose& pose, Registration& registration) noexcept {
    const float quick = rate(seen, pose, registration, false);
    Candidate best{pose, quick + kWorthMoving};
    const auto offer = [&](const body::Pose& other) {
        const float badness = rate(seen, other, registration, false);
        if (badness < best.badness) best = {other, badness};
    };
    for (const body::Pose& other : aim_.reach(seen, body_, registration, pose, left))
        offer(other);
    for (const body::Pose& arms : arms_)
        offer(body::with_arm(pose, left, arms));
    if (best.badness == quick + kWorthMoving) return false;
    const float as_is = rate(seen, pose, registration);
    for (int round = 0; round < kArmRounds; ++round)
        (void)registration.step(seen, options, nullptr, best.pose);
    if (rate(seen, best.pose, registration) + kArmBetter > as_is) return false;
    pose = best.pose;
    return true;
}

void PoseSearch::refine(const SeenPerson& seen, Candidate& candidate, int rounds,
                        Registration& registration) const noexcept {
    static const RegistrationOptions options = wide_options();
    body::Pose pose = candidate.pose;
    for (int round = 0; round < rounds; ++round)
        (void)registration.step(seen, options, nullptr, pose);
    const float badness = rate(seen, pose, registration);
    if (badness < candidate.badness) candidate = {pose, badness};
}

void PoseSearch::look_through_library(const SeenPerson& seen, const Vec3f& up,
                                      const body::Pose* hint, Registration& registration) noexcept {
    best_.clear();
    if (hint != nullptr) keep(seen, *hint, registration);
    const Quatf upright = body::swing(Vec3f::UnitY(), up);
    const Vec3f hips = hips_place(seen, up);
    for (int yaw = 0; yaw < kYaws; ++yaw) {
        const float angle = 2.0f * body::kPi * static_cast<float>(yaw) / kYaws;
        for (std::size_t arm = 0; arm < body::usual_arms().size(); ++arm) {
            body::Pose pose = arms_[arm];
            pose.rotations[0] = upright * body::about(Vec3f::UnitY(), angle);
            pose.hips_position = hips;
            keep(seen, pose, registration);
        }
    }
}

void PoseSearch::sort() noexcept {
    // Few: sorted in place, equal ones keep their order.
    for (std::size_t i = 1; i < best_.size(); ++i)
        for (std::size_t k = i; k > 0 && best_[k].badness < best_[k - 1].badness; --k)
            std::swap(best_[k], best_[k - 1]);
}

std::optional<FoundPose> PoseSearch::advance(const SeenPerson& seen, const Vec3f& up,
                                             const body::Pose* hint,
                                             Registration& registration) noexcept {
    parts_.look(seen);
    if (stage_ == Stage::library) {
        look_through_library(seen, up, hint, registration);
        stage_ = Stage::limbs;
        return std::nullopt;
    }
    if (stage_ == Stage::limbs) {
        for (std::size_t i = 0; i < std::min(kLimbs, best_.size()); ++i) {
            refine(seen, best_[i], kQuickRounds, registration);
            improve_limbs(seen, best_[i], registration);
        }
        sort();
        stage_ = Stage::refinement;
        return std::nullopt;
    }
    best_.resize(std::min(kRefined, best_.size()));
    best_.push_back({turned_around(best_.front().pose), 0.0f});
    for (Candidate& candidate : best_) {
        candidate.badness = rate(seen, candidate.pose, registration);
        refine(seen, candidate, kRounds, registration);
    }
    sort();
    stage_ = Stage::library;
    const float badness = rate(seen, best_.front().pose, registration);
    return FoundPose{best_.front().pose, registration.judge(seen, best_.front().pose), badness};
}

} // namespace toile::body_tracker
