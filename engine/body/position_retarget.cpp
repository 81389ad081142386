#include "body/position_retarget.h"

#include "body/arm_clearance.h"

namespace toile::body {

namespace {

using enum Joint;

std::size_t index(Joint joint) {
    return static_cast<std::size_t>(joint);
}

constexpr PointFilter::Options kTracked{3.0f, 6.0f, 2.0f};
constexpr PointFilter::Options kInferred{1.2f, 0.5f, 1.0f};
constexpr PointFilter::Options kUnseen{0.6f, 0.0f, 1.0f};
constexpr PointFilter::Options kHand{1.5f, 3.0f, 1.5f};

constexpr float kPelvisTilt = 35.0f * kDegree;
constexpr float kSpineBend = 55.0f * kDegree;
constexpr float kNeckBend = 45.0f * kDegree;

Joint sided(std::size_t side, Joint left, Joint right) {
    return side == 0 ? left : right;
}

/// Tilt of q from upright held to a limit; its heading stays.
Quatf limit_tilt(const Quatf& q, float limit) noexcept {
    const Vec3f up = q * Vec3f::UnitY();
    const Quatf tilt = swing(Vec3f::UnitY(), up);
    return (limit_angle(tilt, limit) * tilt.conjugate() * q).normalized();
}

PointFilter::Options options_for(float confidence) noexcept {
    if (confidence <= 0.0f) return kUnseen;
    const float t = smooth_step(0.3f, 1.0f, confidence);
    return {kInferred.minimum_hz + t * (kTracked.minimum_hz - kInferred.minimum_hz),
            kInferred.slope + t * (kTracked.slope - kInferred.slope),
            kInferred.speed_hz + t * (kTracked.speed_hz - kInferred.speed_hz)};
}

} // namespace

PositionRetargeter::PositionRetargeter(const Skeleton& skeleton, const ObservedPerson& person,
                                       std::optional<BodyVolumes> volumes)
    : skeleton_(skeleton), person_(person),
      volumes_(std::move(volumes)), arms_{ArmSolver(skeleton, 0), ArmSolver(skeleton, 1)},
      legs_(skeleton) {}

void PositionRetargeter::reset() noexcept {
    started_ = false;
    for (auto& arm : arms_)
        arm.reset();
    legs_.reset();
    for (auto& filter : points_)
        filter.reset();
    for (std::size_t side = 0; side < 2; ++side) {
        fingertips_[side].reset();
        thumbs_[side].reset();
    }
    frame_ = RetargetedFrame();
}

const Vec3f& PositionRetargeter::point(Joint joint) const noexcept {
    return points_[index(joint)].value();
}

/// Where a point that nobody sees would be in a relaxed stance, hung on its filtered parent.
Vec3f PositionRetargeter::neutral_point(Joint joint) const noexcept {
    const auto parent = joint_parent(joint);
    if (!parent) return points_[0].value();
    const float length = skeleton_.offset(joint).norm() / person_.scale;
    Vec3f direction = unit_or(skeleton_.offset(joint), Vec3f::UnitY());
    const float side = skeleton_.rest(joint).x() < 0.0f ? -1.0f : 1.0f;
    if (joint == left_lower_arm || joint == right_lower_arm)
        direction = Vec3f(0.22f * side, -0.97f, 0.02f).normalized();
    if (joint == left_hand || joint == right_hand)
        direction = Vec3f(0.12f * side, -0.95f, 0.28f).normalized();
    return point(*parent) + observed_chest_ * (length * direction);
}

void PositionRetargeter::filter(const ObservedSkeleton& seen, float dt) noexcept {
    for (std::size_t i = 0; i < kJointCount; ++i) {
        const bool known = seen.confidence[i] > 0.0f && seen.positions[i].allFinite();
        const float confidence = known ? seen.confidence[i] : 0.0f;
        const Vec3f target = known ? seen.positions[i] : neutral_point(static_cast<Joint>(i));
        // A point that was just found again is not trusted at once.
        float& shown = frame_.confidence[i];
        shown += (started_ ? approach(dt, 0.15f) : 1.0f) * (confidence - shown);
        points_[i].update(target, dt, options_for(std::min(confidence, shown)));
    }
    const float share = started_ ? approach(dt, 0.3f) : 1.0f;
    for (std::size_t side = 0; side < 2; ++side) {
        const Vec3f& wrist = seen.positions[index(sided(side, left_hand, right_hand))];
        const auto follow = [&](PointFilter& filter, const Vec3f& p, float c, float& shown) {
            const bool known = c > 0.0f && p.allFinite() && wrist.allFinite();
            shown += share * ((known ? c : 0.0f) - shown);
            if (known) filter.update(p - wrist, dt, kHand);
        };
        follow(fingertips_[side], seen.fingertip[side], seen.fingertip_confidence[side],
               fingertip_confidence_[side]);
        follow(thumbs_[side], seen.thumb[side], seen.thumb_confidence[side],
               thumb_confidence_[side]);
    }
}

void PositionRetargeter::solve_trunk() noexcept {
    const Vec3f shoulders = point(left_upper_arm) - point(right_upper_arm);
    const Vec3f hip_line = point(left_upper_leg) - point(right_upper_leg);
    const Vec3f upper = unit_or(point(upper_chest) - point(chest), Vec3f::UnitY());
    const Vec3f lower = unit_or(point(chest) - point(hips), upper);
    const float trust = smooth_step(
        0.3f, 0.9f,
        std::min({frame_.confidence[index(hips)], frame_.confidence[index(left_upper_leg)],
                  frame_.confidence[index(right_upper_leg)]}));
    const Vec3f lateral = unit_or(shoulders, Vec3f::UnitX());
    const Vec3f pelvis_lateral = trust * unit_or(hip_line, lateral) + (1.15f - trust) * lateral;
    const Vec3f pelvis_up = (0.4f + 0.6f * trust) * lower + 0.6f * (1.0f - trust) * upper;
    const Quatf pelvis = limit_tilt(frame_of(pelvis_lateral, pelvis_up), kPelvisTilt);
    observed_chest_ = frame_of(lateral, upper);
    const Quatf bend = limit_angle(pelvis.conjugate() * observed_chest_, kSpineBend);
    auto& world = frame_.joints;
    world[index(hips)].rotation = pelvis;
    const Quatf identity = Quatf::Identity();
    world[index(spine)].rotation = pelvis * identity.slerp(1.0f / 3.0f, bend);
    world[index(chest)].rotation = pelvis * identity.slerp(2.0f / 3.0f, bend);
    world[index(upper_chest)].rotation = (pelvis * bend).normalized();

    // Hips: the scaled motion, height from where planted ankles are.
    const float ankle = 0.5f * (person_.ankle_height[0] + person_.ankle_height[1]);
    const float rest_ankle =
        0.5f * (skeleton_.rest(left_foot).y() + skeleton_.rest(right_foot).y());
    const Vec3f middle = 0.5f * (point(left_upper_leg) + point(right_upper_leg));
    const Vec3f rest_middle =
        0.5f * (skeleton_.rest(left_upper_leg) + skeleton_.rest(right_upper_leg));
    Vec3f target = person_.scale * (middle - Vec3f(0.0f, ankle, 0.0f));
    target.y() += rest_ankle + person_.hips_raise;
    if (!person_.legs_seen) {
        target.y() = rest_middle.y() + 0.3f * person_.scale * (middle.y() - person_.hips_height);
    }
    world[index(hips)].translation = target - pelvis * Vec3f(rest_middle - skeleton_.rest(hips));
}

void PositionRetargeter::place_trunk() noexcept {
    auto& world = frame_.joints;
    for (const Joint joint : {spine, chest, upper_chest, neck, head}) {
        world[index(joint)].translation =
            world[index(*joint_parent(joint))] * skeleton_.offset(joint);
    }
}

void PositionRetargeter::solve_shoulder(std::size_t side) noexcept {
    const Joint clavicle = sided(side, left_shoulder, right_shoulder);
    const Joint arm = sided(side, left_upper_arm, right_upper_arm);
    auto& world = frame_.joints;
    const Quatf& trunk = world[index(upper_chest)].rotation;
    const Vec3f seen = unit_or(trunk.conjugate() * (point(arm) - point(clavicle)),
                               person_.shoulder_direction[side]);
    const Vec3f& neutral = person_.shoulder_direction[side];
    const float sign = side == 0 ? 1.0f : -1.0f;
    const float raise = std::asin(std::clamp(seen.y(), -1.0f, 1.0f)) -
                        std::asin(std::clamp(neutral.y(), -1.0f, 1.0f));
    const float ahead = std::atan2(seen.z(), std::abs(seen.x()) + 0.05f) -
                        std::atan2(neutral.z(), std::abs(neutral.x()) + 0.05f);
    // Trackers move the shoulder point more than the bone turns.
    const float up = std::clamp(0.7f * raise, -6.0f * kDegree, 24.0f * kDegree);
    const float forward = std::clamp(0.5f * ahead, -14.0f * kDegree, 18.0f * kDegree);
    world[index(clavicle)].rotation =
        (trunk * about(Vec3f::UnitY(), -sign * forward) * about(Vec3f::UnitZ(), sign * up))
            .normalized();
    world[index(clavicle)].translation = world[index(upper_chest)] * skeleton_.offset(clavicle);
}

void PositionRetargeter::solve_head() noexcept {
    auto& world = frame_.joints;
    const Quatf& trunk = world[index(upper_chest)].rotation;
    const Vec3f seen =
        unit_or(trunk.conjugate() * (point(head) - point(neck)), person_.neck_direction);
    const Quatf full = limit_angle(swing(person_.neck_direction, seen), kNeckBend);
    const Quatf bend = Quatf::Identity().slerp(0.8f, full);
    world[index(neck)].rotation = trunk * Quatf::Identity().slerp(0.5f, bend);
    world[index(head)].rotation = (trunk * bend).normalized();
}

void PositionRetargeter::solve_arms(float dt) noexcept {
    auto& world = frame_.joints;
    for (std::size_t side = 0; side < 2; ++side) {
        solve_shoulder(side);
        const Vec3f& shoulder = point(sided(side, left_upper_arm, right_upper_arm));
        const Vec3f& elbow = point(sided(side, left_lower_arm, right_lower_arm));
        const Vec3f& wrist = point(sided(side, left_hand, right_hand));
        ArmDirections seen;
        seen.upper = unit_or(elbow - shoulder, -Vec3f::UnitY());
        seen.lower = unit_or(wrist - elbow, seen.upper);
        seen.hand = unit_or(fingertips_[side].value(), seen.lower);
        seen.thumb = thumbs_[side].value();
        seen.hand_confidence = fingertip_confidence_[side];
        seen.thumb_confidence = thumb_confidence_[side];
        arms_[side].solve(world[index(upper_chest)].rotation, seen, dt, world);
    }
}

void PositionRetargeter::solve_legs(float dt) noexcept {
    std::array<LegTarget, 2> seen;
    const Vec3f facing = frame_.joints[0].rotation * Vec3f::UnitZ();
    const Vec3f ahead =
        person_.ankle_ahead * unit_or(Vec3f(facing.x(), 0.0f, facing.z()), Vec3f::UnitZ());
    for (std::size_t side = 0; side < 2; ++side) {
        const Joint foot = sided(side, left_foot, right_foot);
        const Joint shin = sided(side, left_lower_leg, right_lower_leg);
        const Joint toes = sided(side, left_toes, right_toes);
        const float rest = skeleton_.rest(foot).y();
        const auto place = [&](Joint joint) {
            Vec3f p = point(joint);
            p.y() -= person_.ankle_height[side];
            p *= person_.scale;
            p.y() += rest;
            return p;
        };
        seen[side].ankle = place(foot) + ahead;
        seen[side].knee = place(shin) + 0.5f * ahead;
        seen[side].toe_direction = point(toes) - point(foot);
        seen[side].confidence = person_.legs_seen ? std::min(frame_.confidence[index(shin)],
                                                             frame_.confidence[index(foot)])
                                                  : 0.0f;
    }
    legs_.solve(seen, dt, frame_.joints);
}

const RetargetedFrame& PositionRetargeter::update(const ObservedSkeleton& seen, float dt) noexcept {
    const float step = started_ ? std::clamp(dt, 0.0f, 0.5f) : 0.0f;
    filter(seen, step);
    solve_trunk();
    solve_legs(step); // may lower the hips, so the trunk is placed after
    place_trunk();
    solve_head();
    place_trunk();
    solve_arms(step);
    if (volumes_) frame_.arm_depth = clear_arms(*volumes_, skeleton_, frame_.joints);
    started_ = true;
    return frame_;
}

} // namespace toile::body
