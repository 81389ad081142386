#include "body/target_basis.h"

#include "body/avatar_anatomy.h"

#include <algorithm>
#include <limits>

namespace toile::body {
namespace {

constexpr float kMetresPerUnit = 0.1f; // the data is in decimetres

/// Lays forearms into the rest pose by one fixed turn; linear in the positions.
std::vector<Vec3f> lay_forearm(const ElbowTurn& elbow, std::vector<Vec3f> positions) {
    Vec3f joint = Vec3f::Zero();
    for (const auto v : elbow.elbow)
        joint += positions[v];
    joint /= static_cast<float>(elbow.elbow.size());
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (elbow.share[v] > 0.0f) {
            const Vec3f turned = joint + elbow.turn * (positions[v] - joint);
            positions[v] += elbow.share[v] * (turned - positions[v]);
        }
    return positions;
}

/// The same for joints.
Skeleton lay_forearm(const ElbowTurn& elbow, Skeleton skeleton) {
    const Vec3f joint = skeleton.rest(Joint::left_lower_arm);
    for (std::size_t j = 0; j < kJointCount; ++j)
        if (descends(static_cast<Joint>(j), Joint::left_lower_arm))
            skeleton.rest_positions[j] = joint + elbow.turn * (skeleton.rest_positions[j] - joint);
    return skeleton;
}

/// Coordinates of one shape or displacement of the base mesh, the surface given apart.
Eigen::VectorXf stack(const Eigen::MatrixXd& half, const Skeleton& skeleton) {
    const auto n = static_cast<int>(half.rows());
    Eigen::VectorXf out(3 * n + 3 * static_cast<int>(kJointCount));
    for (int v = 0; v < n; ++v)
        out.segment<3>(3 * v) = half.row(v).transpose().cast<float>();
    for (std::size_t j = 0; j < kJointCount; ++j)
        out.segment<3>(3 * n + 3 * static_cast<int>(j)) = skeleton.rest_positions[j];
    return out;
}

void add_target(const MakeHumanData& data, const std::string& name, std::vector<Vec3f>& offsets) {
    for (const auto& t : data.target(name))
        offsets[t.vertex] += kMetresPerUnit * t.offset;
}

} // namespace

Eigen::VectorXf TargetBasis::coordinates(const Eigen::VectorXd& amounts) const {
    Eigen::VectorXf out = origin;
    for (int t = 0; t < amounts.size(); ++t)
        if (amounts[t] != 0.0) out += static_cast<float>(amounts[t]) * targets.col(t);
    return out;
}

TargetBasis make_target_basis(const MakeHumanData& data, const AvatarTemplate& avatar,
                              const ShapeCarrier& carrier, std::span<const std::string> names) {
    // The turn belongs to the template's shape, as it stood before it was laid.
    std::vector<Vec3f> bare = data.positions;
    for (auto& p : bare)
        p *= kMetresPerUnit;
    std::vector<Vec3f> middle = bare;
    for (const auto& [target, amount] : adult_recipe(0.5))
        for (const auto& t : data.target(target))
            middle[t.vertex] += static_cast<float>(amount) * kMetresPerUnit * t.offset;
    const ElbowTurn elbow = left_elbow_turn(data, middle);

    TargetBasis out;
    const BaseShape made_from = template_shape(data);
    std::vector<Vec3f> offsets = lay_forearm(elbow, bare);
    for (std::size_t v = 0; v < offsets.size(); ++v)
        offsets[v] -= made_from.positions[v];
    Eigen::MatrixXd half = carrier.carry_offsets(offsets);
    for (std::size_t v = 0; v < avatar.half; ++v)
        half.row(static_cast<int>(v)) += avatar.mesh.positions[v].cast<double>().transpose();
    out.origin = stack(half, lay_forearm(elbow, read_joints(data, bare)));

    out.targets.resize(out.origin.size(), static_cast<int>(names.size()));
    for (std::size_t i = 0; i < names.size(); ++i) {
        std::vector<Vec3f> offset(bare.size(), Vec3f::Zero());
        add_target(data, names[i], offset);
        if (const auto left = names[i].find("/l-"); left != std::string::npos)
            add_target(data, std::string(names[i]).replace(left, 3, "/r-"), offset);
        const Skeleton joints = lay_forearm(elbow, read_joints(data, offset));
        out.targets.col(static_cast<int>(i)) =
            stack(carrier.carry_offsets(lay_forearm(elbow, std::move(offset))), joints);
    }
    return out;
}

BodyShape unfold_offsets(const AvatarTemplate& avatar, const Eigen::VectorXf& coordinates) {
    const auto n = static_cast<int>(avatar.half);
    const auto mirrored = [](const Vec3f& p) { return Vec3f(-p.x(), p.y(), p.z()); };
    BodyShape out;
    out.positions.resize(avatar.mesh.positions.size());
    for (std::size_t v = 0; v < avatar.half; ++v) {
        const Vec3f p = coordinates.segment<3>(3 * static_cast<int>(v));
        const auto m = avatar.mirror_of[v];
        out.positions[v] = p;
        if (m != v) out.positions[m] = mirrored(p);
    }
    auto& joints = out.skeleton.rest_positions;
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto other = static_cast<std::size_t>(opposite_joint(static_cast<Joint>(j)));
        if (other < j) continue; // left ones stand first, and count
        joints[j] = coordinates.segment<3>(3 * (n + static_cast<int>(j)));
        if (other == j)
            joints[j].x() = 0.0f;
        else
            joints[other] = mirrored(joints[j]);
    }
    return out;
}

BodyShape unfold(const AvatarTemplate& avatar, const Eigen::VectorXf& coordinates) {
    BodyShape out = unfold_offsets(avatar, coordinates);
    float floor = std::numeric_limits<float>::max();
    for (const auto& p : out.positions)
        floor = std::min(floor, p.y());
    for (auto& p : out.positions)
        p.y() -= floor;
    for (auto& p : out.skeleton.rest_positions)
        p.y() -= floor;
    return out;
}

} // namespace toile::body
