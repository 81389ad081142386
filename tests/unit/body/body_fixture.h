// A plain adult skeleton in an A pose for tests, and quaternion shorthand.
#pragma once

#include "body/skeleton.h"

#include <numbers>
#include <string>

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

inline float radians(float degrees) {
    return degrees * std::numbers::pi_v<float> / 180.0f;
}

inline Quatf turn(const Vec3f& axis, float degrees) {
    return Quatf(Eigen::AngleAxisf(radians(degrees), axis.normalized()));
}

} // namespace toile::test
