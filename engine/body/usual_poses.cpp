#include "body/usual_poses.h"

#include "body/rotations.h"

#include <array>

namespace toile::body {
namespace {

constexpr std::array<ArmPose, 7> kArms{{
    {0.0f, -38.0f, 0.0f, 10.0f, 0.0f},    // hanging
    {0.0f, 0.0f, 0.0f, 0.0f, 0.0f},       // as at rest
    {5.0f, 42.0f, 0.0f, 0.0f, 0.0f},      // out
    {25.0f, 80.0f, 0.0f, 10.0f, 0.0f},    // up
    {0.0f, -5.0f, 70.0f, 10.0f, 0.0f},    // forward
    {0.0f, -8.0f, -15.0f, 85.0f, -50.0f}, // on the hips
    {10.0f, 45.0f, 0.0f, 90.0f, -60.0f},  // out, forearms up
}};
/// Further ways, of one arm only.
constexpr std::array<ArmPose, 3> kSingleArms{{
    {0.0f, -30.0f, 0.0f, 70.0f, 0.0f},   // hanging, forearm forward
    {0.0f, -20.0f, -35.0f, 50.0f, 0.0f}, // swung back
    {0.0f, 10.0f, 90.0f, 80.0f, 0.0f},   // before the chest
}};
constexpr std::array<LegPose, 6> kLegPoses{{
    {0.0f, 0.0f, 0.0f},    // standing
    {28.0f, 10.0f, 0.0f},  // a step forward
    {-20.0f, 15.0f, 0.0f}, // a step back
    {65.0f, 75.0f, 0.0f},  // raised
    {85.0f, 85.0f, 5.0f},  // seated
    {0.0f, 0.0f, 22.0f},   // wide
}};

} // namespace

std::span<const ArmPose> usual_arms() noexcept {
    return kArms;
}

std::span<const ArmPose> single_arms() noexcept {
    return kSingleArms;
}

std::span<const LegPose> usual_legs() noexcept {
    return kLegPoses;
}

Pose usual_pose(const Skeleton& skeleton, const ArmPose& arm, float legs) {
    Pose out;
    const auto turn = [&](Joint joint, const Quatf& q) {
        out.rotations[static_cast<std::size_t>(joint)] = q;
    };
    const auto along = [&](Joint from, Joint to) {
        return Vec3f((skeleton.rest(to) - skeleton.rest(from)).normalized());
    };
    const auto both = [&](Joint left, const Quatf& q) {
        turn(left, q);
        turn(opposite_joint(left), Quatf(q.w(), q.x(), -q.y(), -q.z()));
    };
    const Vec3f upper = along(Joint::left_upper_arm, Joint::left_lower_arm);
    const Vec3f lower = along(Joint::left_lower_arm, Joint::left_hand);
    const Vec3f forward = upper.cross(Vec3f::UnitZ()).normalized();
    const Vec3f bend = lower.cross(Vec3f::UnitZ()).normalized();
    both(Joint::left_shoulder, about(Vec3f::UnitZ(), arm.collar * kDegree));
    both(Joint::left_upper_arm, about(Vec3f::UnitZ(), arm.lift * kDegree) *
                                    about(forward, arm.forward * kDegree) *
                                    about(upper, arm.turn * kDegree));
    both(Joint::left_lower_arm, about(bend, arm.elbow * kDegree));
    both(Joint::left_upper_leg, about(Vec3f::UnitZ(), legs * kDegree));
    return out;
}

Pose with_arm(const Pose& pose, bool left, const Pose& of) noexcept {
    Pose out = pose;
    for (Joint joint :
         {Joint::left_shoulder, Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_hand}) {
        if (!left) joint = opposite_joint(joint);
        const auto j = static_cast<std::size_t>(joint);
        out.rotations[j] = of.rotations[j];
    }
    return out;
}

Pose with_leg(const Pose& pose, bool left, const LegPose& leg) noexcept {
    Pose out = pose;
    const float side = left ? 1.0f : -1.0f;
    const auto turn = [&](Joint joint, const Quatf& q) {
        out.rotations[static_cast<std::size_t>(left ? joint : opposite_joint(joint))] = q;
    };
    turn(Joint::left_upper_leg, about(Vec3f::UnitX(), -leg.forward * kDegree) *
                                    about(Vec3f::UnitZ(), side * leg.out * kDegree));
    turn(Joint::left_lower_leg, about(Vec3f::UnitX(), leg.knee * kDegree));
    turn(Joint::left_foot, Quatf::Identity());
    turn(Joint::left_toes, Quatf::Identity());
    return out;
}

} // namespace toile::body
