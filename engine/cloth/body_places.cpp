#include "cloth/body_places.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::cloth {
namespace {

/// Parent of each joint in the order of abi/body.h; the hips are their own.
constexpr std::array<std::uint8_t, kBodyJoints> kParent{0,  0,  1,  2, 3,  4,  3,  6, 7,  8,  3,
                                                        10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

// hips, spine, chest, upper chest, neck, both shoulders
constexpr JointMask kTrunk = 0b0000000000010001011111u;

/// Joints whose surface runs on from a joint's without a limb between: a walk gets there.
constexpr std::array<JointMask, kBodyJoints> connected() {
    std::array<JointMask, kBodyJoints> next{};
    for (std::size_t j = 0; j < kBodyJoints; ++j) {
        next[j] |= (1u << j) | (1u << kParent[j]);
        next[kParent[j]] |= 1u << j;
        if (((kTrunk >> j) & 1u) != 0) {
            next[j] |= kTrunk;
        }
    }
    return next;
}
constexpr std::array<JointMask, kBodyJoints> kConnected = connected();

} // namespace

JointMask connected_parts(std::uint8_t joint) {
    return kConnected[joint];
}

bool same_part(std::uint8_t a, std::uint8_t b) {
    return a == b || ((kTrunk >> a) & (kTrunk >> b) & 1u) != 0;
}

JointMask covered_parts(const std::array<std::uint16_t, 4>& joints,
                        const std::array<float, 4>& weights) {
    constexpr float kNoticeable = 0.05f;
    JointMask moved = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (weights[k] > kNoticeable) {
            moved |= 1u << joints[k];
        }
    }
    JointMask mask = moved;
    for (std::size_t j = 0; j < kBodyJoints; ++j) {
        if ((moved >> j) & 1u) {
            mask |= 1u << kParent[j];
        }
        if ((moved >> kParent[j]) & 1u) {
            mask |= 1u << j;
        }
    }
    return mask;
}

float signed_distance(const MovingBody& body, const Vec4& p, const SurfacePoint& at) {
    return (p - at.point).dot(body.normal_at(at));
}

bool lifts(const MovingBody& body, const SurfacePoint& own, const SurfacePoint& other) {
    constexpr float kAway = 0.3f; // cosine
    constexpr float kWorn = 0.2f; // m
    return own.squared < kWorn * kWorn && body.normal_at(own).dot(body.normal_at(other)) > kAway;
}

bool on_rim(const MovingBody& body, const SurfacePoint& at, JointMask allowed) {
    for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t next = body.across(at.triangle, side);
        if (at.bary[(side + 2) % 3] <= 0.0f && next != kNone &&
            ((allowed >> body.joint_of(next)) & 1u) == 0) {
            return true;
        }
    }
    return false;
}

bool faces(const MovingBody& body, const SurfacePoint& own, const SurfacePoint& other) {
    constexpr float kAgainst = -0.5f; // cosine
    constexpr float kDeepest = 0.03f; // m
    return own.squared < kDeepest * kDeepest && other.squared < kDeepest * kDeepest &&
           body.normal_at(own).dot(body.normal_at(other)) < kAgainst;
}

bool share_room(SkinPlane& own, SkinPlane& other, const Vec4& at, float offset) {
    constexpr float kFacing = 0.5f; // cosine, from where they leave no way out between them
    const Vec4 n = direction(own.normal);
    const Vec4 m = direction(other.normal);
    const float opposed = -n.dot(m);
    const Vec4 lifted = at + offset * n;
    const float missing = offset - m.dot(lifted) + other.normal.w();
    if (opposed <= 0.0f || missing <= 0.0f) {
        return false;
    }
    const float facing = std::min(1.0f, opposed / kFacing);
    const float both = facing * std::clamp(2.0f - 2.0f * missing / kThinnest, 0.0f, 1.0f);
    // From plane to plane; half of it leads to where both are equally near.
    const Vec4 across = (n - m).normalized();
    const float way = missing / std::sqrt(2.0f + 2.0f * opposed);
    const Vec4 middle = lifted - both * way * across;
    const float turn = both * std::min(1.0f, missing / offset);
    const Vec4 speed = own.velocity + 0.5f * both * (other.velocity - own.velocity);
    const auto put = [&](SkinPlane& plane, const Vec4& normal, const Vec4& velocity, float height) {
        plane.normal = normal.normalized();
        plane.velocity.w() = plane.normal.dot(direction(velocity));
        plane.normal.w() = plane.normal.dot(middle) - height;
    };
    put(own, n + turn * (across - n), speed, offset);
    put(other, m - turn * (across + m), other.velocity + turn * (speed - other.velocity),
        offset - (1.0f - facing) * missing);
    return true;
}

void check_skin(std::span<const std::array<std::uint16_t, 4>> joints,
                std::span<const std::array<float, 4>> weights, std::size_t vertex_count) {
    if (joints.size() != vertex_count || weights.size() != vertex_count) {
        throw Error("garment: " + std::to_string(joints.size()) + " joint rows and " +
                    std::to_string(weights.size()) + " weight rows for " +
                    std::to_string(vertex_count) + " vertices");
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(std::abs(weights[v][k]) <= 1.5f) || joints[v][k] >= kBodyJoints) {
                throw Error("garment: vertex " + std::to_string(v) + " has a bad joint weight");
            }
        }
    }
}

} // namespace toile::cloth
