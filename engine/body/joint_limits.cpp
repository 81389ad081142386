#include "body/joint_limits.h"

#include "body/rotations.h"

namespace toile::body {
namespace {

struct Row {
    Joint joint;
    bool follows_bone;
    std::array<std::array<float, 2>, 3> degrees; // X Y Z, or along, bend, Z; of the left side
};

// X forward bend, Y turn to the left, Z lean to the right for the trunk and neck. Legs: -X is hip
// flexion, +X knee flexion, Z abduction. Arms: bend is flexion (of the shoulder: forward).
constexpr std::array<Row, 13> kRows = {{
    {Joint::spine, false, {{{-12, 30}, {-8, 8}, {-15, 15}}}},
    {Joint::chest, false, {{{-8, 22}, {-12, 12}, {-10, 10}}}},
    {Joint::upper_chest, false, {{{-8, 15}, {-12, 12}, {-8, 8}}}},
    {Joint::neck, false, {{{-30, 25}, {-35, 35}, {-20, 20}}}},
    {Joint::head, false, {{{-30, 20}, {-40, 40}, {-20, 20}}}},
    {Joint::left_shoulder, false, {{{-12, 12}, {-20, 20}, {-10, 35}}}},
    {Joint::left_upper_arm, true, {{{-60, 70}, {-45, 110}, {-40, 85}}}},
    {Joint::left_lower_arm, true, {{{-75, 75}, {-12, 128}, {-4, 4}}}},
    {Joint::left_hand, true, {{{-5, 5}, {-20, 25}, {-60, 65}}}},
    {Joint::left_upper_leg, false, {{{-115, 20}, {-35, 35}, {-20, 40}}}},
    {Joint::left_lower_leg, false, {{{-3, 135}, {-10, 10}, {-3, 3}}}},
    {Joint::left_foot, false, {{{-20, 45}, {-12, 12}, {-15, 25}}}},
    {Joint::left_toes, false, {{{-50, 25}, {-3, 3}, {-3, 3}}}},
}};

bool is_left(Joint joint) {
    return opposite_joint(joint) > joint;
}

/// Where the bone that a joint moves ends.
Joint bone_end(Joint joint) {
    switch (joint) {
    case Joint::left_upper_arm:
        return Joint::left_lower_arm;
    case Joint::left_lower_arm:
        return Joint::left_hand;
    default:
        return joint;
    }
}

Vec3f bone_direction(const Skeleton& skeleton, Joint joint) {
    // The hand goes on where the forearm points.
    const Joint from = joint == Joint::left_hand ? Joint::left_lower_arm : joint;
    return (skeleton.rest(bone_end(from)) - skeleton.rest(from)).normalized();
}

/// Axial vectors under a reflection of x.
Vec3f reflected(const Vec3f& rotation) {
    return {rotation.x(), -rotation.y(), -rotation.z()};
}

} // namespace

JointLimits joint_limits(Joint joint) {
    const Joint row_of = is_left(opposite_joint(joint)) ? opposite_joint(joint) : joint;
    for (const auto& row : kRows) {
        if (row.joint != row_of) continue;
        JointLimits out;
        out.follows_bone = row.follows_bone;
        for (std::size_t k = 0; k < 3; ++k)
            out.range[k] = {row.degrees[k][0] * kDegree, row.degrees[k][1] * kDegree};
        return out;
    }
    return {};
}

Vec3f limited_rotation(const Skeleton& skeleton, Joint joint, const Vec3f& share) {
    const bool right = is_left(opposite_joint(joint)) && !is_left(joint);
    const Joint left = right ? opposite_joint(joint) : joint;
    const JointLimits limits = joint_limits(joint);
    Vec3f angle;
    for (int k = 0; k < 3; ++k) {
        const AngleRange& range = limits.range[static_cast<std::size_t>(k)];
        angle[k] = share[k] >= 0.0f ? share[k] * range.high : -share[k] * range.low;
    }
    Vec3f rotation = angle;
    if (limits.follows_bone) {
        const Vec3f along = bone_direction(skeleton, left);
        const Vec3f bend = along.cross(Vec3f::UnitZ()).normalized();
        rotation = angle.x() * along + angle.y() * bend + angle.z() * Vec3f::UnitZ();
    }
    return right ? reflected(rotation) : rotation;
}

Pose random_pose(const Skeleton& skeleton, Random& random) {
    Pose out = rest_pose(skeleton);
    for (std::size_t j = 1; j < kJointCount; ++j) {
        Vec3f share;
        do {
            for (int k = 0; k < 3; ++k)
                share[k] = static_cast<float>(random.uniform(-1.0, 1.0));
        } while (share.norm() > 1.0f);
        out.rotations[j] =
            from_rotation_vector(limited_rotation(skeleton, static_cast<Joint>(j), share));
    }
    return out;
}

Pose mirrored(const Pose& pose) {
    Pose out;
    out.hips_position =
        Vec3f(-pose.hips_position.x(), pose.hips_position.y(), pose.hips_position.z());
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto other = static_cast<std::size_t>(opposite_joint(static_cast<Joint>(j)));
        const Quatf& q = pose.rotations[other];
        out.rotations[j] = Quatf(q.w(), q.x(), -q.y(), -q.z());
    }
    return out;
}

} // namespace toile::body
