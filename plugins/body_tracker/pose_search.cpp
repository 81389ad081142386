#include "body_tracker/pose_search.h"

#include "body/rotations.h"
#include "body/usual_poses.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

using body::Joint;

constexpr int kYaws = 12;
constexpr std::size_t kKept = 6;  // candidates looked at closely
constexpr std::size_t kMoved = 3; // and moved on to the end
constexpr int kQuickRounds = 4;
constexpr int kRounds = 10;
constexpr float kThickness = 0.10f; // metres from the seen surface to the body's middle

RegistrationOptions wide_options() {
    RegistrationOptions out;
    out.reach_m = 0.25f;
    out.robust_m = 0.10f;
    out.extra_reach_m = 0.6f;
    out.outline_reach_m = 0.6f;
    out.damping = 0.05;
    return out;
}

} // namespace

PoseSearch::PoseSearch(const TrackedBody& body, const GridCamera&) : body_(body) {
    const body::Skeleton& skeleton = body.model().space().model().skeleton;
    for (const auto arms : {body::usual_arms(), body::single_arms()})
        for (const body::ArmPose& arm : arms)
            arms_.push_back(body::usual_pose(skeleton, arm, 0.0f));
    best_.reserve(kKept + 1);
}

/// Where the person's top is: above the mean of its highest cells.
void PoseSearch::place(const SeenPerson& seen, const Vec3f& up) noexcept {
    const GridCamera& camera = seen.grid.camera;
    float high = -1e9f, low = 1e9f;
    Vec3f middle = Vec3f::Zero();
    float count = 0.0f;
    for (std::size_t i = 0; i < seen.mask.cells.size(); ++i) {
        if (seen.mask.cells[i] == 0) continue;
        const auto n = static_cast<int>(i);
        const Vec3f p = camera.point(static_cast<float>(n % camera.width),
                                     static_cast<float>(n / camera.width), seen.grid.depth[i]);
        high = std::max(high, up.dot(p));
        low = std::min(low, up.dot(p));
        middle += p;
        count += 1.0f;
    }
    middle /= std::max(1.0f, count);
    top_ = middle + (high - up.dot(middle)) * up;
    top_ += kThickness * (middle - up.dot(middle) * up).normalized();
    down_m_ = high - low;
}

void PoseSearch::add(const SeenPerson& seen, const body::Pose& pose,
                     Registration& registration) noexcept {
    Candidate candidate{pose, registration.judge(seen, pose).badness()};
    if (best_.size() == kKept && candidate.badness >= best_.back().badness) return;
    const auto at = std::upper_bound(
        best_.begin(), best_.end(), candidate,
        [](const Candidate& a, const Candidate& b) { return a.badness < b.badness; });
    best_.insert(at, candidate);
    if (best_.size() > kKept) best_.pop_back();
}

void PoseSearch::improve_limbs(const SeenPerson& seen, Candidate& candidate,
                               Registration& registration) const noexcept {
    const auto offer = [&](const body::Pose& pose) {
        const float badness = registration.judge(seen, pose).badness();
        if (badness < candidate.badness) candidate = {pose, badness};
    };
    for (const bool left : {true, false})
        for (const body::Pose& arms : arms_)
            offer(body::with_arm(candidate.pose, left, arms));
    for (const bool left : {true, false})
        for (const body::LegPose& leg : body::usual_legs())
            offer(body::with_leg(candidate.pose, left, leg));
}

void PoseSearch::refine(const SeenPerson& seen, Candidate& candidate, int rounds,
                        Registration& registration) const noexcept {
    static const RegistrationOptions options = wide_options();
    body::Pose pose = candidate.pose;
    for (int round = 0; round < rounds; ++round)
        (void)registration.step(seen, options, nullptr, pose);
    const float badness = registration.judge(seen, pose).badness();
    if (badness < candidate.badness) candidate = {pose, badness};
}

FoundPose PoseSearch::find(const SeenPerson& seen, const Vec3f& up, const body::Pose* hint,
                           Registration& registration) noexcept {
    place(seen, up);
    best_.clear();
    if (hint != nullptr) add(seen, *hint, registration);
    const Quatf upright = body::swing(Vec3f::UnitY(), up);
    // The crown stands above the head joint by about as much as the joint above the neck.
    const body::Skeleton& skeleton = body_.skeleton();
    const float crown = 2.1f * (skeleton.rest(Joint::head).y() - skeleton.rest(Joint::neck).y()) +
                        skeleton.rest(Joint::neck).y();
    for (int yaw = 0; yaw < kYaws; ++yaw) {
        const Quatf turn =
            upright *
            body::about(Vec3f::UnitY(), 2.0f * body::kPi * static_cast<float>(yaw) / kYaws);
        for (std::size_t arm = 0; arm < body::usual_arms().size(); ++arm) {
            body::Pose pose = arms_[arm];
            pose.rotations[0] = turn;
            pose.hips_position = top_ - up * (crown - skeleton.rest(Joint::hips).y());
            add(seen, pose, registration);
        }
    }
    for (Candidate& candidate : best_) {
        refine(seen, candidate, kQuickRounds, registration);
        improve_limbs(seen, candidate, registration);
    }
    std::stable_sort(best_.begin(), best_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.badness < b.badness; });
    for (std::size_t i = 0; i < std::min(kMoved, best_.size()); ++i)
        refine(seen, best_[i], kRounds, registration);
    const auto best =
        std::min_element(best_.begin(), best_.end(), [](const Candidate& a, const Candidate& b) {
            return a.badness < b.badness;
        });
    return {best->pose, registration.judge(seen, best->pose)};
}

} // namespace toile::body_tracker
