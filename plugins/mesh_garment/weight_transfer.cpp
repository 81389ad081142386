#include "mesh_garment/weight_transfer.h"

#include "body/skinning.h"
#include "geometry/mesh.h"
#include "mesh_garment/smooth_field.h"

#include <algorithm>
#include <cmath>

namespace toile::mesh_garment {
namespace {

constexpr auto kJoints = static_cast<Eigen::Index>(body::kJointCount);

/// What the body says about each garment vertex.
struct Matches {
    Eigen::MatrixXd weights;     ///< (nv x 22) of the nearest surface point
    Eigen::VectorXd trust;       ///< (nv) positive, at most 1
    std::vector<float> distance; ///< (nv) from the skin, at least 0
};

void add_weights(const BodyView& body, const SurfacePoint& at, Eigen::Index row,
                 Eigen::MatrixXd& weights) {
    const Triangle& t = body.triangles[at.triangle];
    for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t v = t[static_cast<std::size_t>(corner)];
        for (std::size_t k = 0; k < 4; ++k)
            weights(row, body.joint_indices[v][k]) +=
                static_cast<double>(at.barycentric[corner] * body.joint_weights[v][k]);
    }
}

Matches match(const BodySurface& body, std::span<const Vec3f> positions,
              std::span<const Triangle> triangles, const TransferOptions& options) {
    std::vector<Vec3f> normals(positions.size());
    geometry::vertex_normals(positions, triangles, normals);
    const auto n = static_cast<Eigen::Index>(positions.size());
    Matches out{Eigen::MatrixXd::Zero(n, kJoints), Eigen::VectorXd::Zero(n),
                std::vector<float>(positions.size())};
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const SurfacePoint at = body.nearest(positions[v]);
        const auto row = static_cast<Eigen::Index>(v);
        add_weights(body.view(), at, row, out.weights);
        out.distance[v] = std::max(0.0f, at.signed_distance);
        const float cosine = at.normal.dot(normals[v]);
        const float facing =
            std::clamp((cosine - options.least_cosine) / (0.8f - options.least_cosine), 0.0f, 1.0f);
        const double d =
            static_cast<double>(at.signed_distance) / static_cast<double>(options.near_m);
        out.trust[row] =
            std::max(options.least_trust, static_cast<double>(facing) * std::exp(-d * d));
    }
    return out;
}

/// The four largest of each row, not negative, summing to 1.
body::SkinWeights four_largest(const Eigen::MatrixXd& dense) {
    const auto n = static_cast<std::size_t>(dense.rows());
    body::SkinWeights out;
    out.joints.assign(n, {});
    out.weights.assign(n, {});
    for (std::size_t v = 0; v < n; ++v) {
        std::array<std::uint16_t, body::kJointCount> order{};
        for (std::size_t j = 0; j < order.size(); ++j)
            order[j] = static_cast<std::uint16_t>(j);
        const auto row = static_cast<Eigen::Index>(v);
        std::stable_sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
            return dense(row, a) > dense(row, b);
        });
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k)
            sum += std::max(0.0, dense(row, order[k]));
        for (std::size_t k = 0; k < 4; ++k) {
            const double w = std::max(0.0, dense(row, order[k])) / sum;
            if (w <= 0.0) continue;
            out.joints[v][k] = order[k];
            out.weights[v][k] = static_cast<float>(w);
        }
    }
    return out;
}

std::vector<std::array<std::uint32_t, 2>> edges_of(std::size_t vertex_count,
                                                   std::span<const Triangle> triangles) {
    const auto rows = geometry::vertex_adjacency(vertex_count, triangles);
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        for (std::uint32_t k = rows.first[v]; k < rows.first[v + 1]; ++k)
            if (rows.neighbours[k] > v) edges.push_back({v, rows.neighbours[k]});
    return edges;
}

/// Calls visit(a, b, posed length / rest length) for every edge in every pose.
template <typename Visit>
void visit_stretches(std::span<const Vec3f> positions,
                     const std::vector<std::array<std::uint32_t, 2>>& edges,
                     const body::SkinWeights& weights,
                     const std::vector<body::JointTransforms>& poses, Visit&& visit) {
    constexpr float kShortest = 4e-3f; // metres; below, a sliver of the mesh, not a tear
    const body::SkinnedSurface surface(positions, {}, weights.joints, weights.weights);
    std::vector<Vec3f> posed(positions.size());
    for (const auto& pose : poses) {
        surface.pose(pose, body::SkinningMethod::linear_blend,
                     body::VectorRows(std::span<Vec3f>(posed)), {});
        for (const auto& [a, b] : edges) {
            const float rest = (positions[a] - positions[b]).norm();
            if (rest >= kShortest) visit(a, b, (posed[a] - posed[b]).norm() / rest);
        }
    }
}

/// Evens out weights around the edges that tear in a test pose, where the cloth is loose.
void relax(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
           const Matches& matches, const std::vector<body::JointTransforms>& poses,
           const TransferOptions& options, Eigen::MatrixXd& dense) {
    constexpr float kTight = 0.008f; // metres from the skin: below, weights stay the body's
    constexpr float kLoose = 0.030f;
    constexpr float kLeastGive = 0.15f; // of tight cloth
    const auto edges = edges_of(positions.size(), triangles);
    const auto rows = geometry::vertex_adjacency(positions.size(), triangles);
    std::vector<std::uint8_t> marked(positions.size());
    for (int round = 0; round < options.relax_rounds; ++round) {
        std::fill(marked.begin(), marked.end(), std::uint8_t{0});
        visit_stretches(positions, edges, four_largest(dense), poses,
                        [&](std::uint32_t a, std::uint32_t b, float stretch) {
                            if (stretch > options.stretch_bound) marked[a] = marked[b] = 1;
                        });
        for (int grow = 0; grow < 3; ++grow) {
            const std::vector<std::uint8_t> before = marked;
            for (const auto& [a, b] : edges)
                if ((before[a] | before[b]) != 0) marked[a] = marked[b] = 1;
        }
        const Eigen::MatrixXd before = dense;
        bool changed = false;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            const float loose =
                std::clamp((matches.distance[v] - kTight) / (kLoose - kTight), kLeastGive, 1.0f);
            if (marked[v] == 0 || rows.first[v] == rows.first[v + 1]) continue;
            Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(kJoints);
            for (std::uint32_t k = rows.first[v]; k < rows.first[v + 1]; ++k)
                mean += before.row(rows.neighbours[k]);
            mean /= rows.first[v + 1] - rows.first[v];
            const double share = 0.7 * static_cast<double>(loose);
            const auto row = static_cast<Eigen::Index>(v);
            dense.row(row) = (1.0 - share) * before.row(row) + share * mean;
            changed = true;
        }
        if (!changed) return;
    }
}

} // namespace

body::SkinWeights transfer_weights(const BodySurface& body, std::span<const Vec3f> positions,
                                   std::span<const Triangle> triangles,
                                   const TransferOptions& options) {
    const Matches matches = match(body, positions, triangles, options);
    const SurfaceOperator surface = surface_operator(positions, triangles);
    Eigen::MatrixXd dense =
        fill_smoothly(surface, matches.weights, matches.trust, options.smooth_m).cwiseMax(0.0);
    for (Eigen::Index v = 0; v < dense.rows(); ++v)
        dense.row(v) /= std::max(1e-12, dense.row(v).sum());
    relax(positions, triangles, matches, test_poses(body.view().joints), options, dense);
    return four_largest(dense);
}

float worst_stretch(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                    const body::SkinWeights& weights,
                    const std::vector<body::JointTransforms>& poses) {
    float worst = 1.0f;
    visit_stretches(positions, edges_of(positions.size(), triangles), weights, poses,
                    [&worst](std::uint32_t, std::uint32_t, float stretch) {
                        worst = std::max(worst, stretch);
                    });
    return worst;
}

} // namespace toile::mesh_garment
