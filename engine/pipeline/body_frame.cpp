#include "pipeline/body_frame.h"

#include <algorithm>
#include <cmath>

namespace toile::pipeline {

bool plausible(const JointArray& joints) noexcept {
    return std::all_of(joints.begin(), joints.end(), [](const toile_joint& joint) {
        float sum = 0.0f;
        float norm = 0.0f;
        for (const float value : joint.position)
            sum += std::abs(value);
        for (const float value : joint.rotation)
            norm += value * value;
        return std::isfinite(sum) && std::abs(norm - 1.0f) < 1e-2f;
    });
}

body::JointTransforms transforms_of(const JointArray& joints) noexcept {
    body::JointTransforms out;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const toile_joint& joint = joints[i];
        out[i].translation = Vec3f(joint.position[0], joint.position[1], joint.position[2]);
        out[i].rotation =
            Quatf(joint.rotation[3], joint.rotation[0], joint.rotation[1], joint.rotation[2]);
    }
    return out;
}

JointArray joints_of(const body::JointTransforms& world, float confidence) noexcept {
    JointArray out{};
    for (std::size_t i = 0; i < world.size(); ++i) {
        const Vec3f& p = world[i].translation;
        const Quatf& q = world[i].rotation;
        out[i] = {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}, {}, {}, confidence};
    }
    return out;
}

JointArray rest_joints(const body::Skeleton& skeleton) noexcept {
    return joints_of(body::forward_kinematics(skeleton, body::rest_pose(skeleton)), 1.0f);
}

body::Pose local_pose(const body::JointTransforms& world) noexcept {
    body::Pose pose;
    pose.hips_position = world[0].translation;
    for (std::size_t i = 0; i < world.size(); ++i) {
        const auto parent = body::joint_parent(static_cast<body::Joint>(i));
        const Quatf& rotation = world[i].rotation;
        pose.rotations[i] =
            parent ? world[static_cast<std::size_t>(*parent)].rotation.conjugate() * rotation
                   : rotation;
        pose.rotations[i].normalize();
    }
    return pose;
}

body::Pose interpolate(const body::Pose& from, const body::Pose& to, float share) noexcept {
    body::Pose out;
    out.hips_position = from.hips_position + share * (to.hips_position - from.hips_position);
    for (std::size_t i = 0; i < out.rotations.size(); ++i)
        out.rotations[i] = from.rotations[i].slerp(share, to.rotations[i]);
    return out;
}

} // namespace toile::pipeline
