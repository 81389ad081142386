#include "body/fit_model.h"

#include "body/rotations.h"
#include "geometry/laplacian.h"

#include <limits>
#include <numeric>

namespace toile::body {
namespace {
/// Fingers and faces differ from the model in ways that it has no unknowns for.
float trust_of(const BodyModel& model, std::uint32_t vertex) {
    float hand = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto joint = static_cast<Joint>(model.skin.joints[vertex][k]);
        if (joint == Joint::left_hand || joint == Joint::right_hand)
            hand += model.skin.weights[vertex][k];
    }
    if (model.parts[vertex] == Part::head) return 0.6f;
    return 1.0f - 0.8f * hand;
}

bool may_be_clothed(const BodyModel& model, std::uint32_t vertex) {
    if (model.parts[vertex] == Part::head) return false;
    float bare = 0.0f;
    for (std::size_t k = 0; k < 4; ++k)
        switch (static_cast<Joint>(model.skin.joints[vertex][k])) {
        case Joint::left_hand:
        case Joint::right_hand:
        case Joint::left_foot:
        case Joint::right_foot:
        case Joint::left_toes:
        case Joint::right_toes:
            bare += model.skin.weights[vertex][k];
            break;
        default:
            break;
        }
    return bare < 0.5f;
}

bool in_face(const BodyModel& model, std::uint32_t vertex) {
    const float brow = model.rest.positions[model.landmarks.at("brow")].y();
    const float chin = model.skeleton.rest(Joint::head).y();
    const float y = model.rest.positions[vertex].y();
    return model.parts[vertex] == Part::head && y > chin && y < brow &&
           model.rest.normals[vertex].z() > 0.4f;
}

std::array<float, kJointCount> shares_below(const SkinWeights& skin, std::size_t vertex) {
    std::array<float, kJointCount> out{};
    for (std::size_t k = 0; k < 4; ++k)
        for (std::optional<Joint> j = static_cast<Joint>(skin.joints[vertex][k]); j;
             j = joint_parent(*j))
            out[static_cast<std::size_t>(*j)] += skin.weights[vertex][k];
    return out;
}

FitLevel make_fit_level(const BodySpace& space, const PoseTables& tables,
                        std::vector<std::uint32_t> vertices, std::vector<Triangle> triangles) {
    const BodyModel& model = space.model();
    const int k = space.component_count();
    FitLevel out;
    out.vertices = std::move(vertices);
    out.triangles = std::move(triangles);
    const auto n = out.vertices.size();
    out.components.resize(static_cast<int>(3 * n), k);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t v = out.vertices[i];
        out.mean.push_back(model.rest.positions[v]);
        out.mean_normals.push_back(model.rest.normals[v]);
        out.skin.joints.push_back(model.skin.joints[v]);
        out.skin.weights.push_back(model.skin.weights[v]);
        out.correctives.joints.push_back(tables.correctives.joints[v]);
        out.correctives.weights.push_back(tables.correctives.weights[v]);
        out.below.push_back(shares_below(model.skin, v));
        out.trust.push_back(trust_of(model, v));
        out.clothed.push_back(may_be_clothed(model, v) ? 1 : 0);
        out.face.push_back(in_face(model, v) ? 1 : 0);
        for (int c = 0; c < k; ++c)
            out.components.block<3, 1>(static_cast<int>(3 * i), c) =
                model.shape[static_cast<std::size_t>(c)].vertex_offsets[v];
    }
    const Eigen::VectorXd areas =
        geometry::lumped_mass(out.mean, out.triangles, geometry::MassKind::barycentric);
    for (const double area : areas)
        out.areas.push_back(static_cast<float>(area));
    return out;
}

} // namespace

FitModel::FitModel(const std::filesystem::path& folder)
    : space_(BodySpace::load(folder)), tables_(load_pose_tables(space_.model())) {
    const BodyModel& model = space_.model();
    std::vector<std::uint32_t> all(model.rest.positions.size());
    std::iota(all.begin(), all.end(), 0u);
    levels_.push_back(make_fit_level(space_, tables_, all, model.rest.triangles));
    for (const BodyLevel& level : space_.levels())
        levels_.push_back(make_fit_level(space_, tables_, level.vertices, level.triangles));
    const int k = component_count();
    joint_components_.resize(3 * static_cast<int>(kJointCount), k);
    for (int c = 0; c < k; ++c)
        for (std::size_t j = 0; j < kJointCount; ++j)
            joint_components_.block<3, 1>(static_cast<int>(3 * j), c) =
                model.shape[static_cast<std::size_t>(c)].joint_offsets[j];
}

Skeleton FitModel::skeleton(const ShapeVector& shape) const {
    Skeleton out = space_.model().skeleton;
    const Eigen::VectorXf moved = joint_components_ * shape.cast<float>();
    for (std::size_t j = 0; j < kJointCount; ++j)
        out.rest_positions[j] += moved.segment<3>(static_cast<int>(3 * j));
    return out;
}

void pose_level(const FitModel& model, const FitLevel& level, const FitShape& shape,
                const Pose& pose, PosedLevel& out) {
    const std::size_t n = level.vertices.size();
    const Eigen::VectorXf moved = level.components * shape.coefficients.cast<float>();
    out.rest.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
        out.rest[v] = level.mean[v] + moved.segment<3>(static_cast<int>(3 * v));
        if (!shape.offsets.empty())
            out.rest[v] += shape.offsets[level.vertices[v]] * level.mean_normals[v];
    }
    out.skeleton = model.skeleton(shape.coefficients);
    out.positions.resize(n);
    out.normals.resize(n);
    out.rotations.resize(n);
    out.world = forward_kinematics(out.skeleton, pose);
    const auto motions = to_dual_quaternions(skinning_transforms(out.skeleton, out.world));
    const RotationVectors turns = rotation_vectors(pose);
    for (std::size_t v = 0; v < n; ++v) {
        const RigidTransform skin = blend(motions, level.skin.joints[v], level.skin.weights[v]);
        const Vec3f rest = out.rest[v] + level.correctives.weights[v] *
                                             pose_features(turns, level.correctives.joints[v]);
        out.positions[v] = skin * rest;
        out.rotations[v] = skin.rotation;
    }
    geometry::vertex_normals(out.positions, level.triangles, out.normals);
    // Joints move with the shape along the chain of bones.
    const ShapeRows& local = model.joint_components();
    out.joint_moves.resize(local.rows(), local.cols());
    out.joint_moves.topRows<3>().setZero();
    for (std::size_t j = 1; j < kJointCount; ++j) {
        const auto p = static_cast<std::size_t>(*joint_parent(static_cast<Joint>(j)));
        const Mat3f turn = out.world[p].rotation.toRotationMatrix();
        out.joint_moves.middleRows<3>(static_cast<int>(3 * j)) =
            out.joint_moves.middleRows<3>(static_cast<int>(3 * p)) +
            turn * (local.middleRows<3>(static_cast<int>(3 * j)) -
                    local.middleRows<3>(static_cast<int>(3 * p)));
    }
}

BodyShape rest_shape(const FitModel& model, const FitShape& shape) {
    BodyShape out = model.space().shape(
        {shape.coefficients.data(), static_cast<std::size_t>(shape.coefficients.size())});
    if (shape.offsets.empty()) return out;
    const FitLevel& full = model.level(0);
    float floor = std::numeric_limits<float>::max();
    for (std::size_t v = 0; v < out.positions.size(); ++v) {
        out.positions[v] += shape.offsets[v] * full.mean_normals[v];
        floor = std::min(floor, out.positions[v].y());
    }
    for (Vec3f& p : out.positions)
        p.y() -= floor;
    for (Vec3f& p : out.skeleton.rest_positions)
        p.y() -= floor;
    return out;
}

void motion_row(const FitModel& model, const FitLevel& level, const PosedLevel& posed,
                std::uint32_t vertex, const Vec3f& normal, float* row) {
    const int k = model.component_count();
    const ShapeRows& local = model.joint_components();
    Eigen::Map<Eigen::RowVectorXf> shape(row, k);
    const Eigen::RowVector3f rest_normal =
        (posed.rotations[vertex].conjugate() * normal).transpose();
    shape.noalias() = rest_normal * level.components.middleRows<3>(static_cast<int>(3 * vertex));
    for (std::size_t i = 0; i < 4; ++i) {
        const float w = level.skin.weights[vertex][i];
        if (w == 0.0f) continue;
        const auto j = level.skin.joints[vertex][i];
        const Eigen::RowVector3f turned =
            w * (posed.world[j].rotation.conjugate() * normal).transpose();
        shape.noalias() += (w * normal.transpose()) * posed.joint_moves.middleRows<3>(3 * j);
        shape.noalias() -= turned * local.middleRows<3>(3 * j);
    }
    Eigen::Map<Eigen::RowVectorXf> pose(row + k, kPoseUnknowns);
    pose.setZero();
    pose.head<3>() = normal.transpose();
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const float share = level.below[vertex][j];
        if (share == 0.0f) continue;
        Vec3f turn = share * (posed.positions[vertex] - posed.world[j].translation).cross(normal);
        if (const auto parent = joint_parent(static_cast<Joint>(j)))
            turn = posed.world[static_cast<std::size_t>(*parent)].rotation.conjugate() * turn;
        pose.segment<3>(static_cast<int>(3 + 3 * j)) = turn.transpose();
    }
}

Pose moved_pose(const Pose& pose, const double* step) {
    Pose out = pose;
    out.hips_position += Eigen::Map<const Vec3d>(step).cast<float>();
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3f turn = Eigen::Map<const Vec3d>(step + 3 + 3 * j).cast<float>();
        out.rotations[j] = (from_rotation_vector(turn) * out.rotations[j]).normalized();
    }
    return out;
}

} // namespace toile::body
