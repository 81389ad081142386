#include "body/leg_solver.h"

#include "body/rotations.h"

namespace toile::body {

namespace {

constexpr float kStraight = 0.9985f;    ///< of the leg's length: knees never lock
constexpr float kPlantHeight = 0.025f;  ///< metres above the planted ankle
constexpr float kPlantSpeed = 0.25f;    ///< m/s
constexpr float kReleaseSeen = 0.07f;   ///< metres the target may leave a planted foot behind
constexpr float kReleaseUnseen = 0.14f; ///< the same for legs out of view
constexpr float kYawLimit = 32.0f * kDegree;
constexpr float kKneeTurnLimit = 35.0f * kDegree;

std::size_t leg(std::size_t side) {
    return static_cast<std::size_t>(side == 0 ? Joint::left_upper_leg : Joint::right_upper_leg);
}

float yaw_of(const Vec3f& direction) noexcept {
    return std::atan2(direction.x(), direction.z());
}

/// Yaw of a rotation: where it takes +Z, seen from above.
float yaw_of(const Quatf& q) noexcept {
    return yaw_of(Vec3f(q * Vec3f::UnitZ()));
}

Quatf yaw(float angle) noexcept {
    return about(Vec3f::UnitY(), angle);
}

/// Maps unit `from` and the side axis across it to `to` and `side`.
Quatf align(const Vec3f& from, const Vec3f& to, const Vec3f& side) noexcept {
    const auto basis = [](const Vec3f& bone, const Vec3f& x) {
        Mat3f m;
        m.col(0) = bone;
        m.col(1) = unit_or(across(x, bone), bone.unitOrthogonal());
        m.col(2) = m.col(0).cross(m.col(1));
        return m;
    };
    return Quatf(Mat3f(basis(to, side) * basis(from, Vec3f::UnitX()).transpose())).normalized();
}

} // namespace

LegSolver::LegSolver(const Skeleton& skeleton) : skeleton_(skeleton) {
    for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t j = leg(side);
        reach_[side] = kStraight * (skeleton_.offset(static_cast<Joint>(j + 1)).norm() +
                                    skeleton_.offset(static_cast<Joint>(j + 2)).norm());
    }
}

Vec3f LegSolver::neutral_ankle(std::size_t side, const RigidTransform& hips) const noexcept {
    const Vec3f rest = skeleton_.rest_positions[leg(side) + 2];
    const Vec3f from_hips = rest - skeleton_.rest(Joint::hips);
    Vec3f ankle = hips.translation + yaw(yaw_of(hips.rotation)) * from_hips;
    ankle.y() = rest.y();
    return ankle;
}

void LegSolver::place_foot(std::size_t side, const LegTarget& seen, float dt,
                           const RigidTransform& hips) noexcept {
    Foot& foot = feet_[side];
    const float floor_height = skeleton_.rest_positions[leg(side) + 2].y();
    const float confident = smooth_step(0.4f, 0.9f, seen.confidence);
    foot.trust += (started_ ? approach(dt, 0.5f) : 1.0f) * (confident - foot.trust);
    const Vec3f neutral = neutral_ankle(side, hips);
    Vec3f target = neutral + foot.trust * (seen.ankle - neutral);
    // A few centimetres above the floor are noise.
    const float raised = target.y() - floor_height;
    foot.lift = std::max(0.0f, raised) * smooth_step(0.01f, 0.06f, raised);
    target.y() = floor_height;

    // Speed over the ground decides whether the foot stands.
    const float speed = started_ && dt > 0.0f ? (target - foot.last_target).norm() / dt : 0.0f;
    foot.last_target = target;
    if (!started_) foot.ankle = foot.lock = target;
    const bool still = foot.lift < kPlantHeight && (speed < kPlantSpeed || foot.trust < 0.5f);
    const float release = foot.trust < 0.5f ? kReleaseUnseen : kReleaseSeen;
    const Foot& other = feet_[1 - side];
    const bool other_steps = !other.planted && other.behind.norm() > 0.02f;
    const float error = (target - foot.lock).norm();
    if (foot.planted) {
        const bool too_far = error > release && (!other_steps || error > 2.5f * release);
        if (!still || too_far) foot.planted = false;
        foot.behind = foot.lock - target;
    } else if (still && foot.behind.norm() < 0.012f) {
        foot.planted = true;
        foot.lock = target + foot.behind;
    }
    if (foot.planted) {
        foot.ankle = foot.lock;
    } else {
        foot.behind *= 1.0f - approach(dt, 0.12f);
        foot.ankle = target + foot.behind;
        foot.lift = std::max(foot.lift, 0.3f * foot.behind.norm());
    }

    // Feet point with the pelvis, a little aside; while planted they keep their direction.
    const float body_yaw = yaw_of(hips.rotation);
    const Vec3f rest_toes = skeleton_.offset(static_cast<Joint>(leg(side) + 3));
    const float aside = wrap_angle(yaw_of(seen.toe_direction) - yaw_of(rest_toes) - body_yaw);
    const float wanted = body_yaw + foot.trust * std::clamp(aside, -kYawLimit, kYawLimit) * 0.7f;
    const float tau = foot.planted ? 1.5f : 0.15f;
    foot.yaw += (started_ ? approach(dt, tau) : 1.0f) * wrap_angle(wanted - foot.yaw);
}

void LegSolver::bend_leg(std::size_t side, const LegTarget& seen, float dt,
                         JointTransforms& world) noexcept {
    Foot& foot = feet_[side];
    const std::size_t j = leg(side);
    const Quatf& pelvis = world[0].rotation;
    const Vec3f thigh = skeleton_.offset(static_cast<Joint>(j + 1));
    const Vec3f shank = skeleton_.offset(static_cast<Joint>(j + 2));
    const Vec3f& hip = world[j].translation;
    const Vec3f target = foot.ankle + Vec3f(0.0f, foot.lift, 0.0f);
    const Vec3f along = unit_or(target - hip, -Vec3f::UnitY());
    const float a = thigh.norm();
    const float b = shank.norm();
    const float d = std::clamp((target - hip).norm(), 0.3f * (a + b), reach_[side]);

    // The knee's plane: forward between pelvis and foot, turned by what was seen of the knee.
    const Quatf heading = yaw(yaw_of(pelvis) + 0.5f * wrap_angle(foot.yaw - yaw_of(pelvis)));
    const Vec3f ahead = unit_or(across(heading * Vec3f::UnitZ(), along),
                                across(pelvis * Vec3f::UnitY(), along).normalized());
    const Vec3f out = across(seen.knee - 0.5f * (seen.ankle + hip), along);
    const float trust = foot.trust * smooth_step(0.05f, 0.15f, out.norm());
    const float turn = trust > 0.0f ? signed_angle(ahead, out.normalized(), along) : 0.0f;
    const float wanted = trust * std::clamp(turn, -kKneeTurnLimit, kKneeTurnLimit);
    foot.knee_turn += (started_ ? approach(dt, 0.25f) : 1.0f) * (wanted - foot.knee_turn);
    const Vec3f pole = about(along, foot.knee_turn) * ahead;

    const float cosine = std::clamp((a * a + d * d - b * b) / (2.0f * a * d), -1.0f, 1.0f);
    const float sine = std::sqrt(1.0f - cosine * cosine);
    const Vec3f upper = cosine * along + sine * pole;
    const Vec3f ankle = hip + d * along;
    const Vec3f lower = (ankle - (hip + a * upper)).normalized();
    const Vec3f side_axis = pole.cross(along);
    world[j].rotation = align(thigh.normalized(), upper, side_axis);
    world[j + 1].rotation = align(shank.normalized(), lower, side_axis);
    world[j + 1].translation = world[j] * thigh;
    world[j + 2].translation = world[j + 1] * shank;
    // The sole stays level near the floor; a lifted foot hangs a little.
    const float hang = std::min(2.5f * foot.lift, 25.0f * kDegree);
    world[j + 2].rotation = yaw(foot.yaw) * about(Vec3f::UnitX(), hang);
    world[j + 3].rotation = world[j + 2].rotation;
    world[j + 3].translation = world[j + 2] * skeleton_.offset(static_cast<Joint>(j + 3));
}

void LegSolver::solve(const std::array<LegTarget, 2>& seen, float dt,
                      JointTransforms& world) noexcept {
    for (std::size_t side = 0; side < 2; ++side)
        place_foot(side, seen[side], dt, world[0]);
    // Lower the hips until both feet reach.
    float drop = 0.0f;
    for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t j = leg(side);
        const Vec3f hip = world[0] * skeleton_.offset(static_cast<Joint>(j));
        const Vec3f target = feet_[side].ankle + Vec3f(0.0f, feet_[side].lift, 0.0f);
        const Vec2f level(hip.x() - target.x(), hip.z() - target.z());
        const float far = std::min(level.norm(), 0.9f * reach_[side]);
        const float height = std::sqrt(reach_[side] * reach_[side] - far * far);
        drop = std::max(drop, hip.y() - target.y() - height);
    }
    world[0].translation.y() -= drop;
    for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t j = leg(side);
        world[j].translation = world[0] * skeleton_.offset(static_cast<Joint>(j));
        bend_leg(side, seen[side], dt, world);
    }
    started_ = true;
}

} // namespace toile::body
