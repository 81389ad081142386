// Rigid motions as dual quaternions, and their blends (Kavan 2007).
#pragma once

#include "body/skeleton.h"

namespace toile::body {

/// Real and dual part, each x y z w.
struct alignas(16) DualQuaternion {
    Vec4f real = Vec4f::Zero();
    Vec4f dual = Vec4f::Zero();
};

[[nodiscard]] inline DualQuaternion to_dual_quaternion(const RigidTransform& t) noexcept {
    const Quatf half(0.0f, 0.5f * t.translation.x(), 0.5f * t.translation.y(),
                     0.5f * t.translation.z());
    return {t.rotation.coeffs(), (half * t.rotation).coeffs()};
}

using DualQuaternions = std::array<DualQuaternion, kJointCount>;

[[nodiscard]] inline DualQuaternions to_dual_quaternions(const JointTransforms& motions) noexcept {
    DualQuaternions out;
    for (std::size_t j = 0; j < kJointCount; ++j)
        out[j] = to_dual_quaternion(motions[j]);
    return out;
}

/// The blend as a rigid motion; weights of at least one joint are not zero. q and -q are one
/// rotation: each joint counts on the first one's side.
[[nodiscard]] inline RigidTransform blend(const DualQuaternions& motions,
                                          const std::array<std::uint16_t, 4>& joints,
                                          const std::array<float, 4>& weights) noexcept {
    const DualQuaternion& first = motions[joints[0]];
    Vec4f real = weights[0] * first.real, dual = weights[0] * first.dual;
    for (std::size_t k = 1; k < 4; ++k) {
        const DualQuaternion& motion = motions[joints[k]];
        const float w = motion.real.dot(first.real) < 0.0f ? -weights[k] : weights[k];
        real += w * motion.real;
        dual += w * motion.dual;
    }
    const float scale = 1.0f / real.norm();
    RigidTransform out;
    out.rotation = Quatf(Vec4f(real * scale));
    out.translation = 2.0f * (Quatf(Vec4f(dual * scale)) * out.rotation.conjugate()).vec();
    return out;
}

} // namespace toile::body
