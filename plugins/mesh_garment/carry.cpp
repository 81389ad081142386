#include "mesh_garment/carry.h"

#include "mesh_garment/smooth_field.h"
#include "mesh_garment/weight_transfer.h"

#include <algorithm>
#include <cmath>

namespace toile::mesh_garment {
namespace {

bool same_template(const BodyView& a, const BodyView& b) {
    return a.positions.size() == b.positions.size() &&
           std::equal(a.triangles.begin(), a.triangles.end(), b.triangles.begin(),
                      b.triangles.end());
}

std::vector<Vec3f> carry_by_skin(const BodySurface& from, const BodySurface& to,
                                 std::span<const Vec3f> positions,
                                 std::span<const Triangle> triangles) {
    constexpr float kNear = 0.05f;   // metres: a skin point this far counts 1/e
    constexpr double kLeast = 1e-4;  // trust of cloth far from any skin
    constexpr double kSmooth = 0.03; // metres: finer changes of the skin do not reach the cloth
    const auto n = static_cast<Eigen::Index>(positions.size());
    Eigen::MatrixXd moved(n, 3);
    Eigen::VectorXd trust(n);
    for (Eigen::Index v = 0; v < n; ++v) {
        const SurfacePoint at = from.nearest(positions[static_cast<std::size_t>(v)]);
        const Triangle& t = from.view().triangles[at.triangle];
        Vec3f d = Vec3f::Zero();
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = t[static_cast<std::size_t>(k)];
            d += at.barycentric[k] * (to.view().positions[corner] - from.view().positions[corner]);
        }
        moved.row(v) = d.cast<double>().transpose();
        const float far = at.signed_distance / kNear;
        trust[v] = std::max(kLeast, static_cast<double>(std::exp(-far * far)));
    }
    const auto field = fill_smoothly(surface_operator(positions, triangles), moved, trust, kSmooth);
    std::vector<Vec3f> out(positions.begin(), positions.end());
    for (Eigen::Index v = 0; v < n; ++v)
        out[static_cast<std::size_t>(v)] += field.row(v).transpose().cast<float>();
    return out;
}

/// The joint that a bone ends at: the first child, or the joint itself.
std::size_t bone_end(std::size_t joint) {
    for (std::size_t j = joint + 1; j < body::kJointCount; ++j)
        if (body::joint_parent(static_cast<body::Joint>(j)) == static_cast<body::Joint>(joint))
            return j;
    return joint;
}

std::vector<Vec3f> carry_by_bones(const BodySurface& from, const BodySurface& to,
                                  std::span<const Vec3f> positions,
                                  std::span<const Triangle> triangles) {
    const auto weights = transfer_weights(from, positions, triangles);
    const auto& a = from.view().joints;
    const auto& b = to.view().joints;
    std::array<Mat3f, body::kJointCount> linear;
    for (std::size_t j = 0; j < linear.size(); ++j) {
        const std::size_t end = bone_end(j);
        const Vec3f bone_a = a[end] - a[j];
        const Vec3f bone_b = b[end] - b[j];
        linear[j] = Mat3f::Identity();
        if (bone_a.norm() < 0.01f || bone_b.norm() < 0.01f) continue;
        linear[j] = Quatf::FromTwoVectors(bone_a, bone_b).toRotationMatrix() *
                    (bone_b.norm() / bone_a.norm());
    }
    std::vector<Vec3f> out(positions.size(), Vec3f::Zero());
    for (std::size_t v = 0; v < positions.size(); ++v)
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t j = weights.joints[v][k];
            out[v] += weights.weights[v][k] * (b[j] + linear[j] * (positions[v] - a[j]));
        }
    return out;
}

} // namespace

std::vector<Vec3f> carry(const BodySurface& from, const BodySurface& to,
                         std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    if (same_template(from.view(), to.view())) return carry_by_skin(from, to, positions, triangles);
    return carry_by_bones(from, to, positions, triangles);
}

} // namespace toile::mesh_garment
