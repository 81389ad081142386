#include "body/arm_solver.h"

#include "body/rotations.h"

namespace toile::body {

namespace {

constexpr float kUpperRollLimit = 80.0f * kDegree;
constexpr float kForearmRollLimit = 70.0f * kDegree;
constexpr float kHandLimit = 45.0f * kDegree;
constexpr float kElbowLimit = 148.0f * kDegree;

/// `lower` turned back towards `upper` where the elbow would close too far.
Vec3f limit_elbow(const Vec3f& upper, const Vec3f& lower) noexcept {
    const float angle = std::acos(std::clamp(upper.dot(lower), -1.0f, 1.0f));
    if (angle <= kElbowLimit) return lower;
    const Vec3f side = unit_or(across(lower, upper), upper.unitOrthogonal());
    return std::cos(kElbowLimit) * upper + std::sin(kElbowLimit) * side;
}

} // namespace

ArmSolver::ArmSolver(const Skeleton& skeleton, std::size_t side)
    : first_(static_cast<std::size_t>(side == 0 ? Joint::left_upper_arm : Joint::right_upper_arm)) {
    const float sign = side == 0 ? 1.0f : -1.0f;
    for (std::size_t i = 0; i < 3; ++i)
        offset_[i] = skeleton.offset(static_cast<Joint>(first_ + i));
    upper_ = offset_[1].normalized();
    lower_ = offset_[2].normalized();
    forward_ = across(Vec3f::UnitZ(), upper_).normalized();
    // Out and forward: its opposite, inwards and back, is out of reach, so that no swing from here
    // is ever ambiguous. Hanging, the elbow then bends forward and a little inwards.
    const Quatf ahead = about(Vec3f::UnitY(), -sign * 35.0f * kDegree);
    const Vec3f sideways = sign * Vec3f::UnitX();
    reference_ = ahead * sideways;
    reference_from_rest_ = ahead * swing(upper_, sideways);
}

float ArmSolver::upper_roll(const Vec3f& forward, const ArmDirections& seen, float dt) noexcept {
    const Vec3f bend = across(seen.lower, seen.upper);
    const float trust = smooth_step(0.15f, 0.5f, bend.norm());
    const float measured =
        trust > 0.0f ? signed_angle(forward, bend.normalized(), seen.upper) : 0.0f;
    if (!started_) {
        upper_roll_ = trust * measured;
    } else {
        // The near way round: a measured angle beyond +-180 degrees does not flip the arm.
        upper_roll_ += trust * approach(dt, 0.07f) * wrap_angle(measured - upper_roll_);
        upper_roll_ -= (1.0f - trust) * approach(dt, 0.8f) * upper_roll_;
    }
    upper_roll_ = std::clamp(upper_roll_, -kUpperRollLimit, kUpperRollLimit);
    return upper_roll_;
}

float ArmSolver::forearm_roll(const Quatf& lower, const ArmDirections& seen, float dt) noexcept {
    const Vec3f forward = across(lower * Vec3f::UnitZ(), seen.lower);
    const Vec3f thumb = across(seen.thumb, seen.lower);
    const float trust = seen.thumb_confidence * smooth_step(0.015f, 0.05f, thumb.norm());
    const float measured =
        trust > 0.0f ? signed_angle(forward.normalized(), thumb.normalized(), seen.lower) : 0.0f;
    const float target = std::clamp(measured, -kForearmRollLimit, kForearmRollLimit);
    if (!started_) {
        forearm_roll_ = trust * target;
    } else {
        forearm_roll_ += trust * approach(dt, 0.3f) * (target - forearm_roll_);
        forearm_roll_ -= (1.0f - trust) * approach(dt, 1.0f) * forearm_roll_;
    }
    return forearm_roll_;
}

void ArmSolver::solve(const Quatf& chest, const ArmDirections& observed, float dt,
                      JointTransforms& world) noexcept {
    ArmDirections seen = observed;
    seen.lower = limit_elbow(seen.upper, seen.lower);
    // Upper arm: swing from the reference, then roll about the bone.
    const Quatf swung = swing(chest * reference_, seen.upper) * chest * reference_from_rest_;
    const float roll = upper_roll(swung * forward_, seen, dt);
    const Quatf upper = (about(seen.upper, roll) * swung).normalized();
    // Forearm: hinge from the upper arm, then its share of the wrist's roll.
    const Quatf hinged = swing(upper * lower_, seen.lower) * upper;
    const float twist = forearm_roll(hinged, seen, dt);
    const Quatf lower = (about(seen.lower, 0.5f * twist) * hinged).normalized();
    const Quatf rolled = about(seen.lower, twist) * hinged;
    // Hand: bends a little towards the fingertips.
    const Quatf bend = limit_angle(swing(seen.lower, seen.hand), kHandLimit);
    const Quatf wanted = Quatf::Identity().slerp(0.7f * seen.hand_confidence, bend);
    hand_swing_ = started_ ? hand_swing_.slerp(approach(dt, 0.15f), wanted) : wanted;
    started_ = true;

    world[first_].rotation = upper;
    world[first_ + 1].rotation = lower;
    world[first_ + 2].rotation = (hand_swing_ * rolled).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
        const RigidTransform& parent = world[first_ + i - 1];
        world[first_ + i].translation = parent * offset_[i];
    }
}

} // namespace toile::body
