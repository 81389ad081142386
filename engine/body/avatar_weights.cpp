#include "body/avatar_anatomy.h"

#include <algorithm>
#include <numeric>

namespace toile::body {
namespace {

constexpr int kSmoothingSteps = 10; // of half the way to the neighbours' mean
constexpr std::size_t kInfluences = 4;

using JointRow = std::array<float, kJointCount>;

/// left <-> right; joints of the middle are their own.
JointRow mirrored(const JointRow& row) {
    JointRow out{};
    for (std::size_t j = 0; j < kJointCount; ++j)
        out[static_cast<std::size_t>(opposite_joint(static_cast<Joint>(j)))] = row[j];
    return out;
}

/// Rows of the base mesh's vertices, carried to the refined surface.
std::vector<JointRow> refined_rows(const AvatarTemplate& avatar, const MakeHumanData& data) {
    const auto joint_of = bone_joints(data);
    std::vector<JointRow> coarse(data.positions.size(), JointRow{});
    for (std::size_t v = 0; v < coarse.size(); ++v)
        for (const auto& w : data.weights[v])
            coarse[v][static_cast<std::size_t>(joint_of[static_cast<std::size_t>(w.bone)])] +=
                w.weight;
    const auto& matrix = avatar.refinement.weights;
    std::vector<JointRow> out(static_cast<std::size_t>(matrix.rows()), JointRow{});
    for (int row = 0; row < matrix.outerSize(); ++row)
        for (Eigen::SparseMatrix<float, Eigen::RowMajor>::InnerIterator it(matrix, row); it; ++it)
            for (std::size_t j = 0; j < kJointCount; ++j)
                out[static_cast<std::size_t>(row)][j] +=
                    it.value() * coarse[static_cast<std::size_t>(it.col())][j];
    return out;
}

void smooth(const AvatarTemplate& avatar, std::vector<JointRow>& rows) {
    const auto rings =
        geometry::vertex_adjacency(avatar.mesh.positions.size(), avatar.mesh.triangles);
    std::vector<JointRow> next(rows.size());
    for (int step = 0; step < kSmoothingSteps; ++step) {
        for (std::size_t v = 0; v < avatar.half; ++v) {
            JointRow sum{};
            for (auto i = rings.first[v]; i < rings.first[v + 1]; ++i)
                for (std::size_t j = 0; j < kJointCount; ++j)
                    sum[j] += rows[rings.neighbours[i]][j];
            const float share = 0.5f / static_cast<float>(rings.first[v + 1] - rings.first[v]);
            for (std::size_t j = 0; j < kJointCount; ++j)
                next[v][j] = 0.5f * rows[v][j] + share * sum[j];
            if (avatar.mirror_of[v] == v) { // the midline is its own mirror image
                const JointRow other = mirrored(next[v]);
                for (std::size_t j = 0; j < kJointCount; ++j)
                    next[v][j] = 0.5f * (next[v][j] + other[j]);
            } else {
                next[avatar.mirror_of[v]] = mirrored(next[v]);
            }
        }
        rows.swap(next);
    }
}

void keep_largest(const JointRow& row, std::array<std::uint16_t, 4>& joints,
                  std::array<float, 4>& weights) {
    std::array<std::uint16_t, kJointCount> order{};
    std::iota(order.begin(), order.end(), std::uint16_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint16_t a, std::uint16_t b) { return row[a] > row[b]; });
    float sum = 0.0f;
    for (std::size_t k = 0; k < kInfluences; ++k)
        if (row[order[k]] > 1e-3f) sum += row[order[k]];
    for (std::size_t k = 0; k < kInfluences; ++k) {
        const bool used = row[order[k]] > 1e-3f;
        joints[k] = used ? order[k] : std::uint16_t{0};
        weights[k] = used ? row[order[k]] / sum : 0.0f;
    }
}

} // namespace

Part part_of(Joint joint) {
    switch (joint) {
    case Joint::hips:
        return Part::pelvis;
    case Joint::neck:
        return Part::neck;
    case Joint::head:
        return Part::head;
    case Joint::left_upper_arm:
        return Part::left_upper_arm;
    case Joint::left_lower_arm:
    case Joint::left_hand:
        return Part::left_lower_arm;
    case Joint::right_upper_arm:
        return Part::right_upper_arm;
    case Joint::right_lower_arm:
    case Joint::right_hand:
        return Part::right_lower_arm;
    case Joint::left_upper_leg:
        return Part::left_upper_leg;
    case Joint::left_lower_leg:
    case Joint::left_foot:
    case Joint::left_toes:
        return Part::left_lower_leg;
    case Joint::right_upper_leg:
        return Part::right_upper_leg;
    case Joint::right_lower_leg:
    case Joint::right_foot:
    case Joint::right_toes:
        return Part::right_lower_leg;
    default:
        return Part::torso;
    }
}

SkinWeights make_skin_weights(const AvatarTemplate& avatar, const MakeHumanData& data) {
    const auto refined = refined_rows(avatar, data);
    std::vector<JointRow> rows(avatar.mesh.positions.size(), JointRow{});
    for (std::size_t v = 0; v < avatar.half; ++v) {
        const auto& point = avatar.points[v];
        for (int k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < kJointCount; ++j)
                rows[v][j] +=
                    point.barycentric[k] * refined[point.corners[static_cast<std::size_t>(k)]][j];
        if (avatar.mirror_of[v] != v) rows[avatar.mirror_of[v]] = mirrored(rows[v]);
    }
    smooth(avatar, rows);
    SkinWeights out;
    out.joints.resize(rows.size());
    out.weights.resize(rows.size());
    for (std::size_t v = 0; v < avatar.half; ++v) {
        keep_largest(rows[v], out.joints[v], out.weights[v]);
        const auto m = avatar.mirror_of[v];
        if (m == v) continue;
        out.weights[m] = out.weights[v];
        for (std::size_t k = 0; k < kInfluences; ++k)
            out.joints[m][k] = out.weights[v][k] > 0.0f ? static_cast<std::uint16_t>(opposite_joint(
                                                              static_cast<Joint>(out.joints[v][k])))
                                                        : std::uint16_t{0};
    }
    return out;
}

std::vector<Part> make_part_labels(const SkinWeights& weights) {
    std::vector<Part> out;
    for (std::size_t v = 0; v < weights.joints.size(); ++v) {
        std::array<float, 13> sums{};
        for (std::size_t k = 0; k < kInfluences; ++k)
            sums[static_cast<std::size_t>(part_of(static_cast<Joint>(weights.joints[v][k])))] +=
                weights.weights[v][k];
        out.push_back(static_cast<Part>(std::max_element(sums.begin(), sums.end()) - sums.begin()));
    }
    return out;
}

Skeleton symmetric(const Skeleton& skeleton) {
    Skeleton out;
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3f p = skeleton.rest_positions[j];
        const Vec3f q = skeleton.rest(opposite_joint(static_cast<Joint>(j)));
        out.rest_positions[j] = 0.5f * (p + Vec3f(-q.x(), q.y(), q.z()));
    }
    return out;
}

} // namespace toile::body
