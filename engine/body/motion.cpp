#include "body/motion.h"

#include "body/arm_clearance.h"
#include "body/motion_readers.h"
#include "body/rotations.h"
#include "core/error.h"

namespace toile::body {

namespace {

/// The joint to which a joint's bone leads; the joint itself when it has none that matters.
std::size_t bone_end(std::size_t joint) {
    switch (static_cast<Joint>(joint)) {
    case Joint::left_upper_arm:
    case Joint::left_lower_arm:
    case Joint::right_upper_arm:
    case Joint::right_lower_arm:
    case Joint::left_upper_leg:
    case Joint::left_lower_leg:
    case Joint::right_upper_leg:
    case Joint::right_lower_leg:
        return joint + 1;
    default:
        return joint;
    }
}

} // namespace

Pose sample(const Motion& motion, double time_s) {
    if (motion.poses.empty()) return {};
    const auto after = std::upper_bound(motion.times.begin(), motion.times.end(), time_s);
    if (after == motion.times.begin()) return motion.poses.front();
    if (after == motion.times.end()) return motion.poses.back();
    const auto i = static_cast<std::size_t>(after - motion.times.begin());
    const auto t = static_cast<float>((time_s - motion.times[i - 1]) /
                                      (motion.times[i] - motion.times[i - 1]));
    const Pose& a = motion.poses[i - 1];
    const Pose& b = motion.poses[i];
    Pose pose;
    pose.hips_position = a.hips_position + t * (b.hips_position - a.hips_position);
    for (std::size_t j = 0; j < kJointCount; ++j)
        pose.rotations[j] = a.rotations[j].slerp(t, b.rotations[j]).normalized();
    return pose;
}

Pose pose_from_world(const JointTransforms& world) {
    Pose pose;
    pose.hips_position = world[0].translation;
    pose.rotations[0] = world[0].rotation.normalized();
    for (std::size_t j = 1; j < kJointCount; ++j) {
        const auto parent = static_cast<std::size_t>(*joint_parent(static_cast<Joint>(j)));
        pose.rotations[j] = (world[parent].rotation.conjugate() * world[j].rotation).normalized();
    }
    return pose;
}

float lowest_sole(const Skeleton& skeleton, const JointTransforms& world) {
    float lowest = 1e9f;
    for (const Joint foot : {Joint::left_foot, Joint::right_foot}) {
        const auto f = static_cast<std::size_t>(foot);
        const Vec3f& ankle = skeleton.rest_positions[f];
        const Vec3f& toes = skeleton.rest_positions[f + 1];
        const Vec3f heel(ankle.x(), 0.0f, ankle.z() - 0.05f);
        const Vec3f ball(toes.x(), 0.0f, toes.z());
        const Vec3f tip(toes.x(), 0.0f, toes.z() + 0.06f);
        lowest = std::min({lowest, (world[f] * Vec3f(heel - ankle)).y(),
                           (world[f + 1] * Vec3f(ball - toes)).y(),
                           (world[f + 1] * Vec3f(tip - toes)).y()});
    }
    return lowest;
}

std::array<Quatf, kJointCount> rest_alignment(const Skeleton& skeleton,
                                              const std::array<Vec3f, kJointCount>& directions) {
    std::array<Quatf, kJointCount> alignment;
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3f bone = skeleton.rest_positions[bone_end(j)] - skeleton.rest_positions[j];
        const bool aligned = bone.norm() > 1e-6f && directions[j].norm() > 1e-6f;
        alignment[j] =
            aligned ? swing(bone.normalized(), directions[j].normalized()) : Quatf::Identity();
    }
    // Hands go with their forearms.
    for (const Joint hand : {Joint::left_hand, Joint::right_hand}) {
        const auto h = static_cast<std::size_t>(hand);
        alignment[h] = alignment[h - 1];
    }
    return alignment;
}

Motion load_motion(const std::filesystem::path& file, const Skeleton& skeleton,
                   const BodyVolumes* volumes) {
    const std::string extension = file.extension().string();
    Motion motion;
    if (extension == ".bvh") {
        motion = read_bvh_motion(file, skeleton);
    } else if (extension == ".jsonl") {
        motion = read_track(file, skeleton);
    } else if (extension == ".json") {
        motion = read_keyframes(file, skeleton);
    } else {
        throw FileError(file.string(), "not a motion: .bvh, .jsonl or .json is wanted");
    }
    if (motion.poses.empty()) throw FileError(file.string(), "holds no pose");
    if (volumes != nullptr) {
        for (Pose& pose : motion.poses) {
            JointTransforms world = forward_kinematics(skeleton, pose);
            clear_arms(*volumes, skeleton, world);
            pose = pose_from_world(world);
        }
    }
    return motion;
}

Pose load_pose(const std::filesystem::path& file, const Skeleton& skeleton,
               const BodyVolumes* volumes) {
    return load_motion(file, skeleton, volumes).poses.front();
}

} // namespace toile::body
