#include "body/arm_clearance.h"

#include "body/rotations.h"

namespace toile::body {

namespace {

/// A ball on the arm: fraction of the bone (0 upper arm, 1 forearm, 2 hand).
struct Sample {
    int bone;
    float fraction;
};
constexpr std::array<Sample, 11> kSamples = {{{0, 0.55f},
                                              {0, 0.75f},
                                              {0, 1.0f},
                                              {1, 0.2f},
                                              {1, 0.4f},
                                              {1, 0.6f},
                                              {1, 0.8f},
                                              {1, 1.0f},
                                              {2, 0.35f},
                                              {2, 0.7f},
                                              {2, 1.0f}}};

/// The four points of an arm that its samples hang on.
struct Arm {
    std::size_t first; ///< joint index of the upper arm
    std::size_t side;
    Vec3f shoulder, elbow, wrist, tip;
};

Arm arm_of(const BodyVolumes& volumes, const Skeleton& skeleton, const JointTransforms& world,
           std::size_t side) noexcept {
    const auto first =
        static_cast<std::size_t>(side == 0 ? Joint::left_upper_arm : Joint::right_upper_arm);
    const Vec3f tip =
        world[first + 2] * Vec3f(volumes.fingertip[side] - skeleton.rest_positions[first + 2]);
    return {first,
            side,
            world[first].translation,
            world[first + 1].translation,
            world[first + 2].translation,
            tip};
}

Vec3f sample_point(const Arm& arm, const Sample& s) noexcept {
    const std::array<Vec3f, 4> points = {arm.shoulder, arm.elbow, arm.wrist, arm.tip};
    const auto b = static_cast<std::size_t>(s.bone);
    return points[b] + s.fraction * (points[b + 1] - points[b]);
}

float sample_radius(const BodyVolumes& volumes, std::size_t side, const Sample& s,
                    const ClearanceOptions& options) noexcept {
    if (s.bone == 2) return volumes.hand_radius * (1.2f - 0.7f * s.fraction) + options.margin;
    const LimbProfile& limb = s.bone == 0 ? volumes.upper_arm[side] : volumes.lower_arm[side];
    const float radius = limb.start_radius + s.fraction * (limb.end_radius - limb.start_radius);
    return s.bone == 0 ? radius - options.upper_arm_overlap * 2.0f * (1.0f - s.fraction)
                       : radius + options.margin;
}

/// Small rotation about the pivot that moves a point at `lever` by `push`.
Vec3f turn_for(const Vec3f& lever, const Vec3f& push) noexcept {
    return lever.cross(push) / std::max(lever.squaredNorm(), 0.01f);
}

void turn_from(JointTransforms& world, std::size_t joint, std::size_t last,
               const Quatf& turn) noexcept {
    const Vec3f pivot = world[joint].translation;
    for (std::size_t j = joint; j <= last; ++j) {
        world[j].rotation = (turn * world[j].rotation).normalized();
        world[j].translation = pivot + turn * (world[j].translation - pivot);
    }
}

/// One step of one arm; the deepest sample before it.
float ease(const BodyVolumes& volumes, const Skeleton& skeleton, JointTransforms& world,
           std::size_t side, const ClearanceOptions& options) noexcept {
    const Arm arm = arm_of(volumes, skeleton, world, side);
    Vec3f at_shoulder = Vec3f::Zero();
    Vec3f at_elbow = Vec3f::Zero();
    float weight = 0.0f;
    float deepest = 0.0f;
    for (const Sample& s : kSamples) {
        const Vec3f point = sample_point(arm, s);
        const auto [depth, out] =
            volumes.depth(point, sample_radius(volumes, side, s, options), skeleton, world);
        if (depth <= 0.0f) continue;
        const Vec3f push = depth * out;
        weight += depth;
        deepest = std::max(deepest, depth);
        const float shoulder_share = s.bone == 0 ? 1.0f : 0.55f;
        at_shoulder += depth * shoulder_share * turn_for(point - arm.shoulder, push);
        if (s.bone > 0)
            at_elbow += depth * (1.0f - shoulder_share) * turn_for(point - arm.elbow, push);
    }
    if (weight <= 0.0f) return 0.0f;
    turn_from(world, arm.first, arm.first + 2, from_rotation_vector(at_shoulder / weight));
    turn_from(world, arm.first + 1, arm.first + 2, from_rotation_vector(at_elbow / weight));
    return deepest;
}

} // namespace

float clear_arms(const BodyVolumes& volumes, const Skeleton& skeleton, JointTransforms& world,
                 const ClearanceOptions& options) noexcept {
    float deepest = 0.0f;
    for (std::size_t side = 0; side < 2; ++side) {
        float left_over = 0.0f;
        for (int i = 0; i < options.iterations; ++i) {
            left_over = ease(volumes, skeleton, world, side, options);
            if (left_over == 0.0f) break;
        }
        deepest = std::max(deepest, left_over);
    }
    return deepest;
}

} // namespace toile::body
