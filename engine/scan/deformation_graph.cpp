#include "scan/deformation_graph.h"

#include "core/error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <queue>
#include <string>

namespace toile::scan {
namespace {

constexpr std::size_t kOfVertex = 4; // nodes that move a vertex
constexpr float kFar = std::numeric_limits<float>::infinity();

/// A vertex reached from a node.
struct Reached {
    float way = 0.0f; // along the edges, metres
    std::uint32_t vertex = 0;
    std::uint32_t node = 0;

    /// For a queue whose top is the nearest; equal ways in order of the numbers.
    bool operator<(const Reached& b) const {
        if (way != b.way) return way > b.way;
        return vertex != b.vertex ? vertex > b.vertex : node > b.node;
    }
};

using Queue = std::priority_queue<Reached>;

/// Shortens `way` (nv) by the ways from one more vertex.
void spread(const geometry::VertexAdjacency& around, std::span<const Vec3f> positions,
            std::uint32_t from, std::vector<float>& way) {
    Queue queue;
    way[from] = 0.0f;
    queue.push({0.0f, from, 0});
    while (!queue.empty()) {
        const Reached at = queue.top();
        queue.pop();
        if (at.way > way[at.vertex]) continue;
        for (std::uint32_t k = around.first[at.vertex]; k < around.first[at.vertex + 1]; ++k) {
            const std::uint32_t next = around.neighbours[k];
            const float length = at.way + (positions[next] - positions[at.vertex]).norm();
            if (!(length < way[next])) continue;
            way[next] = length;
            queue.push({length, next, 0});
        }
    }
}

/// The nearest nodes of each vertex, one more than move it.
using Nearest = std::array<std::pair<float, std::uint32_t>, kOfVertex + 1>;

std::vector<Nearest> nearest_nodes(const geometry::VertexAdjacency& around,
                                   std::span<const Vec3f> positions,
                                   std::span<const std::uint32_t> nodes) {
    Nearest none;
    none.fill({kFar, 0});
    std::vector<Nearest> out(positions.size(), none);
    std::vector<std::uint8_t> found(positions.size(), 0);
    Queue queue;
    for (std::uint32_t n = 0; n < nodes.size(); ++n)
        queue.push({0.0f, nodes[n], n});
    while (!queue.empty()) {
        const Reached at = queue.top();
        queue.pop();
        Nearest& slots = out[at.vertex];
        std::uint8_t& count = found[at.vertex];
        if (count == slots.size()) continue;
        const auto end = slots.begin() + count;
        if (std::any_of(slots.begin(), end, [&](const auto& s) { return s.second == at.node; }))
            continue;
        slots[count++] = {at.way, at.node};
        for (std::uint32_t k = around.first[at.vertex]; k < around.first[at.vertex + 1]; ++k) {
            const std::uint32_t next = around.neighbours[k];
            if (found[next] < slots.size())
                queue.push(
                    {at.way + (positions[next] - positions[at.vertex]).norm(), next, at.node});
        }
    }
    return out;
}

void normalise(NodeBinding& binding) {
    float sum = 0.0f;
    for (const float w : binding.weights)
        sum += w;
    for (float& w : binding.weights)
        w /= sum;
}

} // namespace

Warp blended(const NodeBinding& binding, std::span<const Warp> motions) {
    Warp out = binding.weights[0] * motions[binding.nodes[0]];
    for (std::size_t k = 1; k < NodeBinding::kMost; ++k)
        if (binding.weights[k] > 0.0f) out += binding.weights[k] * motions[binding.nodes[k]];
    return out;
}

DeformationGraph::DeformationGraph(const geometry::TriangleMesh& shape, std::size_t node_count) {
    if (shape.positions.empty() || shape.triangles.empty())
        throw Error("a deformation graph needs a surface");
    if (node_count == 0 || node_count > kMostNodes || node_count > shape.positions.size())
        throw Error("a deformation graph has 1 to " + std::to_string(kMostNodes) +
                    " nodes, no more than vertices; " + std::to_string(node_count) + " are asked");
    choose_nodes(shape, node_count);
    bind(shape);
    find_links(shape.triangles);
}

void DeformationGraph::shift(const Vec3f& by) {
    for (Vec3f& node : nodes_)
        node += by;
}

/// Each the vertex that is farthest from those before, the first the one that is lowest.
void DeformationGraph::choose_nodes(const geometry::TriangleMesh& shape, std::size_t count) {
    const auto around = geometry::vertex_adjacency(shape.positions.size(), shape.triangles);
    std::vector<float> way(shape.positions.size(), kFar);
    std::uint32_t next = 0;
    for (std::uint32_t v = 1; v < shape.positions.size(); ++v)
        if (shape.positions[v].y() < shape.positions[next].y()) next = v;
    while (node_vertices_.size() < count) {
        node_vertices_.push_back(next);
        nodes_.push_back(shape.positions[next]);
        spread(around, shape.positions, next, way);
        for (std::uint32_t v = 0; v < way.size(); ++v)
            if (around.first[v] < around.first[v + 1] && way[v] > way[next]) next = v;
        if (way[next] == 0.0f) break;
    }
}

void DeformationGraph::bind(const geometry::TriangleMesh& shape) {
    const auto around = geometry::vertex_adjacency(shape.positions.size(), shape.triangles);
    const auto nearest = nearest_nodes(around, shape.positions, node_vertices_);
    bindings_.resize(shape.positions.size());
    for (std::size_t v = 0; v < bindings_.size(); ++v) {
        const Nearest& near = nearest[v];
        // Weights fall to zero at the first node that is left out, so that none ever jumps.
        float reach = near.back().first;
        for (std::size_t k = kOfVertex; !(reach < kFar) && k-- > 0;)
            reach = near[k].first < kFar ? 1.5f * near[k].first + 1e-3f : kFar;
        NodeBinding& binding = bindings_[v];
        if (!(reach < kFar)) { // no node can be reached: stray vertices
            binding.weights[0] = 1.0f;
            continue;
        }
        for (std::size_t k = 0; k < kOfVertex; ++k) {
            if (!(near[k].first < kFar)) break;
            const float share = std::max(1e-6f, 1.0f - near[k].first / std::max(reach, 1e-6f));
            binding.nodes[k] = static_cast<std::uint8_t>(near[k].second);
            binding.weights[k] = share * share;
        }
        normalise(binding);
    }
}

void DeformationGraph::find_links(std::span<const Triangle> triangles) {
    const std::size_t count = nodes_.size();
    std::vector<std::uint8_t> together(count * count, 0);
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t)
            for (const std::uint32_t w : t)
                for (std::size_t k = 0; k < kOfVertex; ++k)
                    for (std::size_t l = 0; l < kOfVertex; ++l)
                        if (bindings_[v].weights[k] > 0.0f && bindings_[w].weights[l] > 0.0f)
                            together[std::size_t{bindings_[v].nodes[k]} * count +
                                     bindings_[w].nodes[l]] = 1;
    link_of_.assign(count * count, -1);
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = a; b < count; ++b)
            if (a == b || together[a * count + b] != 0 || together[b * count + a] != 0) {
                link_of_[a * count + b] = link_of_[b * count + a] =
                    static_cast<std::int32_t>(links_.size());
                links_.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b)});
            }
}

NodeBinding DeformationGraph::at(const Triangle& triangle, const Vec3f& barycentric) const {
    std::array<std::pair<float, std::uint8_t>, 3 * kOfVertex> sums;
    std::size_t count = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const NodeBinding& corner = bindings_[triangle[c]];
        for (std::size_t k = 0; k < kOfVertex; ++k) {
            const float w = barycentric[static_cast<int>(c)] * corner.weights[k];
            if (!(w > 0.0f)) continue;
            const auto end = sums.begin() + static_cast<std::ptrdiff_t>(count);
            const auto same = std::find_if(
                sums.begin(), end, [&](const auto& s) { return s.second == corner.nodes[k]; });
            if (same != end)
                same->first += w;
            else
                sums[count++] = {w, corner.nodes[k]};
        }
    }
    std::sort(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(count),
              [](const auto& a, const auto& b) {
                  return a.first != b.first ? a.first > b.first : a.second < b.second;
              });
    NodeBinding out;
    for (std::size_t k = 0; k < std::min<std::size_t>(count, NodeBinding::kMost); ++k) {
        out.weights[k] = sums[k].first;
        out.nodes[k] = sums[k].second;
    }
    if (count == 0) return bindings_[triangle[0]];
    normalise(out);
    return out;
}

Eigen::Isometry3d best_rigid(std::span<const Vec3f> from, std::span<const Vec3f> to,
                             std::span<const float> weights) {
    Vec3d a = Vec3d::Zero(), b = Vec3d::Zero();
    double sum = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const auto w = static_cast<double>(weights[i]);
        a += w * from[i].cast<double>();
        b += w * to[i].cast<double>();
        sum += w;
    }
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    if (!(sum > 0.0)) return out;
    a /= sum, b /= sum;
    Eigen::Matrix3d together = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i)
        together += static_cast<double>(weights[i]) * (to[i].cast<double>() - b) *
                    (from[i].cast<double>() - a).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(together,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3d sign = Vec3d::Ones();
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign.z() = -1.0;
    out.linear() = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    out.translation() = b - out.linear() * a;
    return out;
}

std::vector<Eigen::Isometry3d> node_motions(const DeformationGraph& graph,
                                            std::span<const Vec3f> from,
                                            std::span<const Vec3f> to) {
    const std::size_t count = graph.nodes().size();
    std::vector<std::vector<Vec3f>> a(count), b(count);
    std::vector<std::vector<float>> weights(count);
    for (std::size_t v = 0; v < from.size(); ++v)
        for (std::size_t k = 0; k < kOfVertex; ++k) {
            const NodeBinding& binding = graph.bindings()[v];
            if (!(binding.weights[k] > 0.0f)) continue;
            a[binding.nodes[k]].push_back(from[v]);
            b[binding.nodes[k]].push_back(to[v]);
            weights[binding.nodes[k]].push_back(binding.weights[k]);
        }
    std::vector<Eigen::Isometry3d> out;
    for (std::size_t n = 0; n < count; ++n)
        out.push_back(best_rigid(a[n], b[n], weights[n]));
    return out;
}

} // namespace toile::scan
