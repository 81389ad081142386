#include "body/corrective_skin.h"

#include "core/error.h"

namespace toile::body {

CorrectiveSkin::CorrectiveSkin(BodyShape shape, const SkinWeights& skin,
                               const Correctives& correctives)
    : shape_(std::move(shape)) {
    const std::size_t n = shape_.positions.size();
    if (skin.joints.size() != n || skin.weights.size() != n || correctives.joints.size() != n ||
        correctives.weights.size() != n)
        throw Error("skin weights or correctives do not fit a body of " + std::to_string(n) +
                    " vertices");
    for (std::size_t v = 0; v < n; ++v)
        vertices_.push_back({shape_.positions[v], skin.weights[v], skin.joints[v],
                             correctives.joints[v], correctives.weights[v]});
}

void CorrectiveSkin::pose(const Pose& pose, std::span<Vec3f> positions) const noexcept {
    const auto motions = to_dual_quaternions(
        skinning_transforms(shape_.skeleton, forward_kinematics(shape_.skeleton, pose)));
    const RotationVectors turns = rotation_vectors(pose);
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        const Vertex& in = vertices_[v];
        const Vec3f rest = in.position + in.corrective * pose_features(turns, in.near);
        positions[v] = blend(motions, in.joints, in.weights) * rest;
    }
}

} // namespace toile::body
