#include "body/scape.h"

#include "body/rotations.h"
#include "core/error.h"
#include "geometry/laplacian.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile::body {
namespace {

// Against the skinned surface, 1/m^2: features longer than about 0.2 m stay in place, so that small
// errors of Q do not add up along a limb.
constexpr double kPull = 25.0;
constexpr double kHeldPull = 1000.0; // the same where one bone holds the skin: from 3 cm on
constexpr float kLoose = 0.80f, kTight = 0.99f; // weight of a vertex's first joint
constexpr float kNear = 0.1f;        // metres; of joints that shape flesh beyond their skin
constexpr float kNearCounts = 0.05f; // against 0.25, half way between two joints

/// Share of a vertex that moves with each joint or what hangs on it.
std::array<float, kJointCount> shares_below(const SkinWeights& skin, std::size_t vertex) {
    std::array<float, kJointCount> out{};
    for (std::size_t k = 0; k < 4; ++k)
        for (std::optional<Joint> j = static_cast<Joint>(skin.joints[vertex][k]); j;
             j = joint_parent(*j))
            out[static_cast<std::size_t>(*j)] += skin.weights[vertex][k];
    return out;
}

/// The four largest of three corners' mean weights, sum 1.
void mean_weights(const SkinWeights& skin, const Triangle& t, std::array<std::uint16_t, 4>& joints,
                  std::array<float, 4>& weights) {
    std::array<float, kJointCount> sum{};
    for (const auto v : t)
        for (std::size_t k = 0; k < 4; ++k)
            sum[skin.joints[v][k]] += skin.weights[v][k];
    float total = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto largest = std::max_element(sum.begin(), sum.end());
        joints[k] = *largest > 0.0f ? static_cast<std::uint16_t>(largest - sum.begin()) : joints[0];
        weights[k] = *largest;
        total += *largest;
        *largest = 0.0f;
    }
    for (auto& w : weights)
        w /= total;
}

} // namespace

RotationVectors rotation_vectors(const Pose& pose) noexcept {
    RotationVectors out;
    for (std::size_t j = 0; j < kJointCount; ++j)
        out[j] = rotation_vector(pose.rotations[j]);
    return out;
}

std::vector<NearJoints> nearest_joints(const BodyModel& model,
                                       std::span<const Triangle> triangles) {
    std::vector<NearJoints> out;
    for (const auto& t : triangles) {
        const Vec3f middle =
            (model.rest.positions[t[0]] + model.rest.positions[t[1]] + model.rest.positions[t[2]]) /
            3.0f;
        std::array<float, kJointCount> score{};
        for (const auto v : t) {
            const auto below = shares_below(model.skin, v);
            for (std::size_t j = 1; j < kJointCount; ++j)
                score[j] += below[j] * (1.0f - below[j]) / 3.0f;
        }
        for (std::size_t j = 1; j < kJointCount; ++j)
            score[j] +=
                kNearCounts * std::exp(-(model.skeleton.rest_positions[j] - middle).norm() / kNear);
        score[0] = -1.0f; // the hips place the body, they do not bend it
        NearJoints nearest{};
        for (auto& joint : nearest) {
            const auto best = std::max_element(score.begin(), score.end());
            joint = static_cast<std::uint8_t>(best - score.begin());
            *best = -1.0f;
        }
        out.push_back(nearest);
    }
    return out;
}

Tangents tangents(std::span<const Vec3f> positions, const Triangle& triangle) {
    const Vec3f along = positions[triangle[1]] - positions[triangle[0]];
    const Vec3f normal = along.cross(positions[triangle[2]] - positions[triangle[0]]);
    Tangents out;
    out.col(0) = along.normalized();
    out.col(1) = normal.cross(along).normalized();
    return out;
}

float held_by_one_bone(const std::array<float, 4>& weights) noexcept {
    return smooth_step(kLoose, kTight, *std::max_element(weights.begin(), weights.end()));
}

ScapeModel::ScapeModel(const BodyModel& model, PoseDeformation deformation)
    : rest_(model.rest.positions), triangles_(model.rest.triangles), skin_(model.skin),
      deformation_(std::move(deformation)) {
    if (!deformation_.weights.empty() && (deformation_.weights.size() != triangles_.size() ||
                                          deformation_.joints.size() != triangles_.size()))
        throw Error("a pose deformation of " + std::to_string(deformation_.weights.size()) +
                    " triangles does not fit a body of " + std::to_string(triangles_.size()));
    for (const auto& t : triangles_) {
        Corners c;
        const Vec3f &a = rest_[t[0]], &b = rest_[t[1]], &d = rest_[t[2]];
        const Vec3f cross = (b - a).cross(d - a);
        const float doubled = std::max(cross.norm(), 1e-12f);
        const Vec3f normal = cross / doubled;
        c.area = 0.5f * doubled;
        c.tangents = tangents(rest_, t);
        c.gradient = {normal.cross(d - b) / doubled, normal.cross(a - d) / doubled,
                      normal.cross(b - a) / doubled};
        mean_weights(skin_, t, c.joints, c.weights);
        corners_.push_back(c);
    }
    laplacian_ = geometry::cotangent_laplacian(rest_, triangles_);
    pull_ = geometry::lumped_mass(rest_, triangles_, geometry::MassKind::barycentric);
    for (int v = 0; v < pull_.size(); ++v)
        pull_[v] *= kPull + kHeldPull * static_cast<double>(held_by_one_bone(
                                            skin_.weights[static_cast<std::size_t>(v)]));
    Eigen::SparseMatrix<double> system = laplacian_;
    system += Eigen::SparseMatrix<double>(pull_.asDiagonal());
    solver_.compute(system);
    if (solver_.info() != Eigen::Success) throw Error("SCAPE: the system cannot be factored");
}

void ScapeModel::skin(const JointTransforms& skinning, std::span<const Vec3f> positions,
                      std::span<Quatf> rotations, std::span<Vec3f> places) const {
    const auto motions = to_dual_quaternions(skinning);
    for (std::size_t v = 0; v < rest_.size(); ++v)
        places[v] = blend(motions, skin_.joints[v], skin_.weights[v]) * positions[v];
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        rotations[t] = blend(motions, corners_[t].joints, corners_[t].weights).rotation;
}

void ScapeModel::solve(std::span<const Mat3f> matrices, std::span<const Vec3f> places,
                       std::span<Vec3f> result) const {
    const auto n = static_cast<int>(rest_.size());
    Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> right =
        Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>::Zero(n, 3);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            right.row(static_cast<int>(triangles_[t][k])) +=
                (corners_[t].area * (matrices[t] * corners_[t].gradient[k])).transpose();
    Eigen::MatrixXd system = right.cast<double>();
    for (int v = 0; v < n; ++v)
        system.row(v) += pull_[v] * places[static_cast<std::size_t>(v)].cast<double>().transpose();
    const Eigen::MatrixXd x = solver_.solve(system);
    for (int v = 0; v < n; ++v)
        result[static_cast<std::size_t>(v)] = x.row(v).cast<float>();
}

std::vector<Mat3f> ScapeModel::shape_matrices(std::span<const Vec3f> positions) const {
    if (positions.size() != rest_.size())
        throw Error("a shape of " + std::to_string(positions.size()) +
                    " vertices does not fit a model of " + std::to_string(rest_.size()));
    std::vector<Mat3f> out(triangles_.size(), Mat3f::Identity());
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto v = triangles_[t][k];
            out[t] += (positions[v] - rest_[v]) * corners_[t].gradient[k].transpose();
        }
    return out;
}

Mat3f ScapeModel::flesh_change(std::size_t triangle, const RotationVectors& turns) const {
    const Eigen::Matrix<float, 6, 1> q =
        deformation_.weights[triangle] * pose_features(turns, deformation_.joints[triangle]);
    return Eigen::Map<const Tangents>(q.data()) * corners_[triangle].tangents.transpose();
}

ScapeBody::ScapeBody(const ScapeModel& model, BodyShape shape)
    : model_(model), shape_(std::move(shape)), S_(model.shape_matrices(shape_.positions)),
      matrices_(S_.size()), rotations_(S_.size()), places_(shape_.positions.size()) {}

void ScapeBody::pose(const Pose& pose, std::span<Vec3f> positions) {
    const auto skinning =
        skinning_transforms(shape_.skeleton, forward_kinematics(shape_.skeleton, pose));
    model_.skin(skinning, shape_.positions, rotations_, places_);
    const PoseDeformation& learned = model_.deformation();
    const RotationVectors turns = rotation_vectors(pose);
    for (std::size_t t = 0; t < matrices_.size(); ++t) {
        Mat3f M = S_[t];
        if (!learned.weights.empty()) M += S_[t] * model_.flesh_change(t, turns);
        matrices_[t] = rotations_[t].toRotationMatrix() * M;
    }
    model_.solve(matrices_, places_, positions);
}

} // namespace toile::body
