// Scalar and vector types used everywhere. Storage is single precision; solvers use double.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace toile {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec4f = Eigen::Vector4f;
using Vec3d = Eigen::Vector3d;
using Quatf = Eigen::Quaternionf;
using Mat3f = Eigen::Matrix3f;
using Mat4f = Eigen::Matrix4f;

/// Vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A rigid motion: p -> rotation * p + translation.
struct RigidTransform {
    Quatf rotation = Quatf::Identity();
    Vec3f translation = Vec3f::Zero();

    [[nodiscard]] Vec3f operator*(const Vec3f& p) const { return rotation * p + translation; }
    [[nodiscard]] RigidTransform operator*(const RigidTransform& b) const {
        return {rotation * b.rotation, rotation * b.translation + translation};
    }
    [[nodiscard]] RigidTransform inverse() const {
        const Quatf r = rotation.conjugate();
        return {r, -(r * translation)};
    }
};

} // namespace toile
