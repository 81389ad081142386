#include "body/skinning.h"

#include "body/dual_quaternion.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace toile::body {

namespace {

using Vec4 = Eigen::Vector4f; // 16-byte aligned: one SSE register

/// Columns x, y, z and translation of a rigid motion.
struct alignas(16) Columns {
    std::array<Vec4, 4> c;
};

Columns to_columns(const RigidTransform& t) noexcept {
    const Mat3f r = t.rotation.toRotationMatrix();
    Columns m;
    for (int i = 0; i < 3; ++i)
        m.c[static_cast<std::size_t>(i)] << r.col(i), 0.0f;
    m.c[3] << t.translation, 0.0f;
    return m;
}

void store(const VectorRows& rows, std::size_t i, const Vec4& v) noexcept {
    float* const row =
        reinterpret_cast<float*>(reinterpret_cast<char*>(rows.data) + i * rows.stride);
    row[0] = v[0];
    row[1] = v[1];
    row[2] = v[2];
}

/// Unit length; a vector that vanished keeps a defined direction.
Vec4 unit_or_up(const Vec4& v) noexcept {
    const float length2 = v.squaredNorm();
    return length2 > 1e-20f ? Vec4(v / std::sqrt(length2)) : Vec4(0.0f, 1.0f, 0.0f, 0.0f);
}

[[noreturn]] void refuse(std::size_t vertex, const std::string& what) {
    throw Error("skin of vertex " + std::to_string(vertex) + ": " + what);
}

} // namespace

SkinnedSurface::SkinnedSurface(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                               std::span<const std::array<std::uint16_t, 4>> joints,
                               std::span<const std::array<float, 4>> weights)
    : vertices_(positions.size()) {
    if (joints.size() != positions.size() || weights.size() != positions.size() ||
        (!normals.empty() && normals.size() != positions.size())) {
        throw Error("a skin needs as many normals, joints and weights as positions (" +
                    std::to_string(positions.size()) + ")");
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (!positions[v].allFinite()) refuse(v, "position is not finite");
        if (!normals.empty() && !normals[v].allFinite()) refuse(v, "normal is not finite");
        std::array<std::pair<float, std::uint16_t>, 4> slots;
        float sum = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = weights[v][k];
            if (!std::isfinite(weight) || weight < 0.0f)
                refuse(v, "weight is negative or not finite");
            if (weight > 0.0f && joints[v][k] >= kJointCount) {
                refuse(v, "joint " + std::to_string(joints[v][k]) + " does not exist");
            }
            slots[k] = {weight, joints[v][k]};
            sum += weight;
        }
        if (std::abs(sum - 1.0f) > 1e-3f) refuse(v, "weights sum to " + std::to_string(sum));
        std::stable_sort(slots.begin(), slots.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        Vertex& vertex = vertices_[v];
        for (std::size_t k = 0; k < 4; ++k) {
            vertex.weights[k] = slots[k].first / sum;
            vertex.joints[k] = slots[k].first > 0.0f ? slots[k].second : slots[0].second;
        }
        const Vec3f normal = normals.empty() ? Vec3f(Vec3f::UnitY()) : normals[v];
        for (std::size_t k = 0; k < 3; ++k) {
            vertex.position[k] = positions[v][static_cast<Eigen::Index>(k)];
            vertex.normal[k] = normal[static_cast<Eigen::Index>(k)];
        }
    }
}

void SkinnedSurface::pose(const JointTransforms& skinning, SkinningMethod method,
                          VectorRows positions, VectorRows normals) const noexcept {
    if (method == SkinningMethod::dual_quaternion) {
        pose_dual_quaternion(skinning, positions, normals);
    } else {
        pose_linear(skinning, positions, normals);
    }
}

void SkinnedSurface::pose_linear(const JointTransforms& skinning, VectorRows positions,
                                 VectorRows normals) const noexcept {
    std::array<Columns, kJointCount> matrices;
    std::transform(skinning.begin(), skinning.end(), matrices.begin(), to_columns);
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        const Vertex& in = vertices_[v];
        std::array<Vec4, 4> m;
        const Columns& first = matrices[in.joints[0]];
        for (std::size_t c = 0; c < 4; ++c)
            m[c] = in.weights[0] * first.c[c];
        for (std::size_t k = 1; k < 4; ++k) {
            const Columns& joint = matrices[in.joints[k]];
            for (std::size_t c = 0; c < 4; ++c)
                m[c] += in.weights[k] * joint.c[c];
        }
        if (positions.data != nullptr) {
            store(positions, v,
                  m[0] * in.position[0] + m[1] * in.position[1] + m[2] * in.position[2] + m[3]);
        }
        if (normals.data != nullptr) {
            store(normals, v,
                  unit_or_up(m[0] * in.normal[0] + m[1] * in.normal[1] + m[2] * in.normal[2]));
        }
    }
}

void SkinnedSurface::pose_dual_quaternion(const JointTransforms& skinning, VectorRows positions,
                                          VectorRows normals) const noexcept {
    const DualQuaternions joints = to_dual_quaternions(skinning);
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        const Vertex& in = vertices_[v];
        const DualQuaternion& first = joints[in.joints[0]];
        Vec4 real = in.weights[0] * first.real;
        Vec4 dual = in.weights[0] * first.dual;
        for (std::size_t k = 1; k < 4; ++k) {
            // q and -q are one rotation: take the one on the heaviest joint's side.
            const DualQuaternion& joint = joints[in.joints[k]];
            const float w = joint.real.dot(first.real) < 0.0f ? -in.weights[k] : in.weights[k];
            real += w * joint.real;
            dual += w * joint.dual;
        }
        const float scale = 1.0f / real.norm(); // > 0: all parts lie in one half space
        const Quatf rotation(Vec4(real * scale));
        const Mat3f r = rotation.toRotationMatrix();
        if (positions.data != nullptr) {
            const Quatf moved = Quatf(Vec4(dual * scale)) * rotation.conjugate();
            const Vec3f p =
                r * Vec3f(in.position[0], in.position[1], in.position[2]) + 2.0f * moved.vec();
            store(positions, v, Vec4(p.x(), p.y(), p.z(), 0.0f));
        }
        if (normals.data != nullptr) {
            const Vec3f n = r * Vec3f(in.normal[0], in.normal[1], in.normal[2]);
            store(normals, v, unit_or_up(Vec4(n.x(), n.y(), n.z(), 0.0f)));
        }
    }
}

} // namespace toile::body
