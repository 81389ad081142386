// An embedded deformation graph (Sumner et al. 2007; P2 4.2): some tens of nodes on a template,
// each with a rigid motion of its own, blended in between.
#pragma once

#include "geometry/mesh.h"
#include "scan/volume.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::scan {

/// Which nodes move a place, and how much; weights sum to 1, unused ones are 0.
struct NodeBinding {
    static constexpr int kMost = 6;
    std::array<std::uint8_t, kMost> nodes{};
    std::array<float, kMost> weights{};
};

[[nodiscard]] Warp blended(const NodeBinding& binding, std::span<const Warp> motions);

/// Nodes spread over a surface by the way along it, so that an arm beside the trunk is far from it.
class DeformationGraph {
  public:
    static constexpr std::size_t kMostNodes = 255;

    /// `shape`: one surface in the pose in which places are counted; pieces of it get nodes each.
    /// \throw Error for an empty one, or more nodes than `kMostNodes` or vertices
    DeformationGraph(const geometry::TriangleMesh& shape, std::size_t node_count);

    [[nodiscard]] std::span<const Vec3f> nodes() const { return nodes_; } ///< (nn)
    /// (nn) the vertices that they are.
    [[nodiscard]] std::span<const std::uint32_t> node_vertices() const { return node_vertices_; }
    /// (nv) of each vertex of the shape: four nodes near it along the surface.
    [[nodiscard]] std::span<const NodeBinding> bindings() const { return bindings_; }
    /// Between the corners of a triangle.
    [[nodiscard]] NodeBinding at(const Triangle& triangle, const Vec3f& barycentric) const;

    /// Counts all places from elsewhere.
    void shift(const Vec3f& by);

    /// Pairs of nodes (first <= second) that move some place together, each node with itself too.
    [[nodiscard]] std::span<const std::array<std::uint8_t, 2>> links() const { return links_; }
    /// Number of a pair among `links`, in either order; -1: none.
    [[nodiscard]] int link(std::uint8_t a, std::uint8_t b) const {
        return link_of_[std::size_t{a} * nodes_.size() + b];
    }

  private:
    void choose_nodes(const geometry::TriangleMesh& shape, std::size_t count);
    void bind(const geometry::TriangleMesh& shape);
    void find_links(std::span<const Triangle> triangles);

    std::vector<std::uint32_t> node_vertices_;
    std::vector<Vec3f> nodes_;
    std::vector<NodeBinding> bindings_;
    std::vector<std::array<std::uint8_t, 2>> links_;
    std::vector<std::int32_t> link_of_; // (nn * nn)
};

/// Rigid motion that lays `from` on `to` (rows belong together), least squares with weights.
[[nodiscard]] Eigen::Isometry3d best_rigid(std::span<const Vec3f> from, std::span<const Vec3f> to,
                                           std::span<const float> weights);

/// The motions of all nodes that carry the shape's vertices at `from` (nv) to `to` (nv), each the
/// best for what it moves.
[[nodiscard]] std::vector<Eigen::Isometry3d>
node_motions(const DeformationGraph& graph, std::span<const Vec3f> from, std::span<const Vec3f> to);

} // namespace toile::scan
