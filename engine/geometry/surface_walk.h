// Nearest points on a surface that moves: found by walking over its triangles from where the last
// one was, so that a query that changed little costs a few triangles.
#pragma once

#include "geometry/nearest_surface.h"

#include <limits>
#include <span>
#include <vector>

namespace toile::geometry {

/// Nearest point found by a walk.
struct WalkPoint {
    std::uint32_t triangle = kNoTriangle;                   ///< kNoTriangle: p was not finite
    float squared = std::numeric_limits<float>::infinity(); ///< m^2, to the point
    float bary[3] = {0.0f, 0.0f, 0.0f};
    Vec4f point = Vec4f::Zero();
};

/// How the triangles of a mesh hang together; immutable. Positions are given with each query, as
/// rows of four with w = 0.
class SurfaceWalk {
  public:
    /// A set of groups of triangles, one bit each.
    using GroupMask = std::uint32_t;

    /// `groups` (nf) in [0, 32), or empty: all triangles are in group 0.
    /// \throw Error when an index is out of range or the groups do not match
    SurfaceWalk(std::span<const Triangle> triangles, std::size_t vertex_count,
                std::span<const std::uint8_t> groups = {});

    /// Goes downhill from `start` over triangles of the groups in `allowed`: the nearest point
    /// within reach of a descent, which is the nearest one when `start` is close to it.
    [[nodiscard]] WalkPoint walk(std::span<const Vec4f> positions, const Vec4f& p,
                                 std::uint32_t start,
                                 GroupMask allowed = ~GroupMask{0}) const noexcept;

    [[nodiscard]] std::span<const Triangle> triangles() const noexcept { return triangles_; }
    [[nodiscard]] std::uint8_t group_of(std::uint32_t triangle) const noexcept {
        return groups_[triangle];
    }
    /// Neighbour across side k (from corner k to k + 1), or kNoTriangle.
    [[nodiscard]] std::uint32_t across(std::uint32_t triangle, std::size_t side) const noexcept {
        return across_[3 * std::size_t{triangle} + side];
    }
    /// Triangles at a vertex.
    [[nodiscard]] std::span<const std::uint32_t> star(std::uint32_t vertex) const noexcept {
        return std::span(star_).subspan(star_first_[vertex],
                                        star_first_[vertex + 1] - star_first_[vertex]);
    }

  private:
    /// Nearest point of one triangle; replaces `best` when nearer.
    void closest_on(std::span<const Vec4f> positions, const Vec4f& p, std::uint32_t triangle,
                    WalkPoint& best, int& feature) const noexcept;

    std::vector<Triangle> triangles_;
    std::vector<std::uint8_t> groups_;      ///< (nf)
    std::vector<std::uint32_t> across_;     ///< (3 nf)
    std::vector<std::uint32_t> star_first_; ///< (nv + 1)
    std::vector<std::uint32_t> star_;       ///< triangles at each vertex
    std::vector<std::uint32_t> ring_;       ///< the corner after it in each of these
    std::vector<std::uint8_t> border_;      ///< (nv) 1: some side at the vertex has no neighbour
};

} // namespace toile::geometry
