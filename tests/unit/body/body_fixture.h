// A plain adult in an A pose for tests: skeleton, and a body of tubes with weights and part labels.
#pragma once

#include "body/body_model.h"
#include "body/skeleton.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace toile::test {

/// 1.70 m tall, arms 40 degrees below the horizontal.
inline body::Skeleton adult_skeleton() {
    body::Skeleton s;
    const auto set = [&](const char* name, float x, float y, float z) {
        s.rest_positions[static_cast<std::size_t>(*body::joint_from_name(name))] = Vec3f(x, y, z);
    };
    set("hips", 0, 0.95f, 0);
    set("spine", 0, 1.03f, -0.005f);
    set("chest", 0, 1.14f, -0.015f);
    set("upperChest", 0, 1.26f, -0.02f);
    set("neck", 0, 1.42f, -0.02f);
    set("head", 0, 1.50f, 0.005f);
    for (const float side : {1.0f, -1.0f}) {
        const std::string prefix = side > 0 ? "left" : "right";
        const auto limb = [&](const char* name, float x, float y, float z) {
            set((prefix + name).c_str(), side * x, y, z);
        };
        limb("Shoulder", 0.03f, 1.37f, -0.01f);
        limb("UpperArm", 0.17f, 1.36f, -0.02f);
        limb("LowerArm", 0.38f, 1.184f, -0.025f);
        limb("Hand", 0.565f, 1.03f, 0.005f);
        limb("UpperLeg", 0.09f, 0.89f, 0.0f);
        limb("LowerLeg", 0.105f, 0.49f, 0.005f);
        limb("Foot", 0.115f, 0.085f, -0.02f);
        limb("Toes", 0.125f, 0.02f, 0.11f);
    }
    return s;
}

/// Closed tubes around the bones, each vertex rigid on one joint; trunk and pelvis are one tube.
struct TubeBody {
    std::vector<Vec3f> positions;
    std::vector<body::Part> parts;
    std::vector<std::uint16_t> joints;
    std::vector<Triangle> triangles;

    /// Elliptic tube from a to b: half widths across at both ends, `x` the direction of the first.
    void add(const Vec3f& a, const Vec3f& b, Vec2f start, Vec2f end, const Vec3f& x,
             body::Joint joint, body::Part part) {
        constexpr std::uint32_t sides = 20;
        constexpr std::uint32_t rings = 9;
        const auto first = static_cast<std::uint32_t>(positions.size());
        const Vec3f along = (b - a).normalized();
        const Vec3f u = (x - x.dot(along) * along).normalized();
        const Vec3f v = along.cross(u);
        for (std::uint32_t r = 0; r < rings; ++r) {
            const float t = static_cast<float>(r) / (rings - 1);
            const bool cap = r == 0 || r + 1 == rings;
            const Vec2f half = (start + t * (end - start)) * (cap ? 0.3f : 1.0f);
            for (std::uint32_t s = 0; s < sides; ++s) {
                const float angle =
                    2.0f * std::numbers::pi_v<float> * static_cast<float>(s) / sides;
                positions.push_back(a + t * (b - a) + half.x() * std::cos(angle) * u +
                                    half.y() * std::sin(angle) * v);
                parts.push_back(part);
                joints.push_back(static_cast<std::uint16_t>(joint));
            }
        }
        for (std::uint32_t r = 0; r + 1 < rings; ++r) {
            for (std::uint32_t s = 0; s < sides; ++s) {
                const std::uint32_t p = first + r * sides + s;
                const std::uint32_t q = first + r * sides + (s + 1) % sides;
                triangles.push_back({p, q, p + sides});
                triangles.push_back({q, q + sides, p + sides});
            }
        }
    }
};

inline TubeBody tube_body(const body::Skeleton& s) {
    using enum body::Joint;
    using body::Part;
    TubeBody tube;
    const Vec3f x = Vec3f::UnitX();
    const Vec3f z = Vec3f::UnitZ();
    tube.add({0, 0.80f, 0}, s.rest(spine), {0.165f, 0.115f}, {0.15f, 0.11f}, x, hips, Part::pelvis);
    tube.add(s.rest(spine), s.rest(chest), {0.15f, 0.11f}, {0.13f, 0.1f}, x, spine, Part::torso);
    tube.add(s.rest(chest), s.rest(upper_chest), {0.13f, 0.1f}, {0.15f, 0.12f}, x, chest,
             Part::torso);
    tube.add(s.rest(upper_chest), {0, 1.41f, -0.02f}, {0.15f, 0.12f}, {0.13f, 0.07f}, x,
             upper_chest, Part::torso);
    tube.add(s.rest(neck) - Vec3f(0, 0.03f, 0), s.rest(head), {0.055f, 0.055f}, {0.055f, 0.055f}, x,
             neck, Part::neck);
    tube.add(s.rest(head) - Vec3f(0, 0.02f, 0), {0, 1.72f, 0.02f}, {0.07f, 0.09f}, {0.07f, 0.09f},
             x, head, Part::head);
    for (std::size_t side = 0; side < 2; ++side) {
        const bool left = side == 0;
        const auto limb = [&](body::Joint joint, Vec2f start, Vec2f end, const Vec3f& first,
                              Part part) {
            tube.add(s.rest(joint), s.rest_positions[static_cast<std::size_t>(joint) + 1], start,
                     end, first, joint, part);
        };
        limb(left ? left_upper_arm : right_upper_arm, {0.05f, 0.05f}, {0.04f, 0.04f}, z,
             left ? Part::left_upper_arm : Part::right_upper_arm);
        const Part forearm = left ? Part::left_lower_arm : Part::right_lower_arm;
        const body::Joint wrist = left ? left_hand : right_hand;
        limb(left ? left_lower_arm : right_lower_arm, {0.04f, 0.04f}, {0.03f, 0.027f}, z, forearm);
        tube.add(s.rest(wrist), s.rest(wrist) + 0.17f * s.offset(wrist).normalized(),
                 {0.03f, 0.022f}, {0.035f, 0.01f}, z, wrist, forearm);
        limb(left ? left_upper_leg : right_upper_leg, {0.085f, 0.085f}, {0.06f, 0.06f}, x,
             left ? Part::left_upper_leg : Part::right_upper_leg);
        const Part shin = left ? Part::left_lower_leg : Part::right_lower_leg;
        const body::Joint ankle = left ? left_foot : right_foot;
        limb(left ? left_lower_leg : right_lower_leg, {0.06f, 0.06f}, {0.04f, 0.04f}, x, shin);
        const Vec3f under(s.rest(ankle).x(), 0.04f, s.rest(ankle).z() - 0.05f);
        tube.add(under, under + Vec3f(left ? 0.02f : -0.02f, 0, 0.24f), {0.04f, 0.04f},
                 {0.045f, 0.03f}, x, ankle, shin);
    }
    return tube;
}

inline float radians(float degrees) {
    return degrees * std::numbers::pi_v<float> / 180.0f;
}

inline Quatf turn(const Vec3f& axis, float degrees) {
    return Quatf(Eigen::AngleAxisf(radians(degrees), axis.normalized()));
}

} // namespace toile::test
