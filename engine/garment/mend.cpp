#include "garment/mend.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace toile::garment {
namespace {

constexpr double kLeastArea = 2e-9; ///< m^2; the package format wants 1e-9
constexpr float kNudge = 4e-6f;     ///< metres between copies of a vertex

struct UnionFind {
    std::vector<std::uint32_t> parent;

    explicit UnionFind(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    }
    /// The lowest index leads.
    bool unite(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a == b) return false;
        parent[std::max(a, b)] = std::min(a, b);
        return true;
    }
};

/// Leader of each vertex after merging those within `distance`.
std::vector<std::uint32_t> merge_near(std::span<const Vec3f> positions, double distance,
                                      std::size_t& merged) {
    const auto limit = static_cast<float>(distance);
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return positions[a].x() < positions[b].x();
    });
    UnionFind sets(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const Vec3f d = positions[order[j]] - positions[order[i]];
            if (d.x() > limit) break;
            if (d.norm() > limit) continue;
            const bool apart = d.squaredNorm() > 0.0f;
            if (sets.unite(order[i], order[j]) && apart) ++merged;
        }
    std::vector<std::uint32_t> leader(positions.size());
    for (std::uint32_t i = 0; i < leader.size(); ++i)
        leader[i] = sets.find(i);
    return leader;
}

double area(std::span<const Vec3f> positions, const Triangle& t) {
    const Vec3d a = positions[t[0]].cast<double>();
    return 0.5 *
           (positions[t[1]].cast<double>() - a).cross(positions[t[2]].cast<double>() - a).norm();
}

/// A triangle's side from its vertex k to the next.
struct Side {
    std::uint32_t triangle;
    std::uint32_t k;
};
using Edge = std::pair<std::uint32_t, std::uint32_t>;
using EdgeSides = std::map<Edge, std::vector<Side>>;

EdgeSides sides_of(const std::vector<Triangle>& triangles) {
    EdgeSides edges;
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[i][k];
            const std::uint32_t b = triangles[i][(k + 1) % 3];
            edges[std::minmax(a, b)].push_back({i, k});
        }
    return edges;
}

bool same_direction(const std::vector<Triangle>& triangles, const Side& a, const Side& b) {
    return triangles[a.triangle][a.k] == triangles[b.triangle][b.k];
}

/// Turns triangles so that neighbours agree; in each piece the smaller side is turned.
std::size_t orient(std::vector<Triangle>& triangles, std::vector<Triangle>& corners) {
    const EdgeSides edges = sides_of(triangles);
    std::vector<std::vector<std::pair<std::uint32_t, bool>>> neighbours(triangles.size());
    for (const auto& [edge, sides] : edges) {
        if (sides.size() != 2) continue;
        const bool disagree = same_direction(triangles, sides[0], sides[1]);
        neighbours[sides[0].triangle].emplace_back(sides[1].triangle, disagree);
        neighbours[sides[1].triangle].emplace_back(sides[0].triangle, disagree);
    }
    std::size_t turned = 0;
    std::vector<int> turn(triangles.size(), -1);
    for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
        if (turn[seed] >= 0) continue;
        std::vector<std::uint32_t> piece = {seed};
        turn[seed] = 0;
        std::size_t ones = 0;
        for (std::size_t at = 0; at < piece.size(); ++at)
            for (const auto& [other, disagree] : neighbours[piece[at]]) {
                if (turn[other] >= 0) continue;
                turn[other] = turn[piece[at]] ^ (disagree ? 1 : 0);
                ones += static_cast<std::size_t>(turn[other]);
                piece.push_back(other);
            }
        const int minority = 2 * ones <= piece.size() ? 1 : 0;
        for (const std::uint32_t t : piece)
            if (turn[t] == minority) {
                std::swap(triangles[t][1], triangles[t][2]);
                std::swap(corners[t][1], corners[t][2]);
                ++turned;
            }
    }
    return turned;
}

/// Sews corners together across edges with two agreeing triangles only: every fan of triangles gets
/// a vertex of its own, so the result is manifold whatever the input.
void sew(std::span<const Vec3f> positions, const std::vector<Triangle>& triangles,
         MendedMesh& out) {
    UnionFind corners(3 * triangles.size());
    for (const auto& [edge, sides] : sides_of(triangles)) {
        if (sides.size() != 2 || same_direction(triangles, sides[0], sides[1])) {
            if (sides.size() > 1) ++out.cut_edges;
            continue;
        }
        const auto corner = [](const Side& s, std::uint32_t step) {
            return 3 * s.triangle + (s.k + step) % 3;
        };
        corners.unite(corner(sides[0], 0), corner(sides[1], 1));
        corners.unite(corner(sides[0], 1), corner(sides[1], 0));
    }
    std::map<std::uint32_t, std::uint32_t> number; // leading corner -> new vertex
    std::map<std::uint32_t, std::uint32_t> copies; // input vertex -> copies made so far
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        Triangle t{};
        Vec3f centre = Vec3f::Zero();
        for (const std::uint32_t v : triangles[i])
            centre += positions[v] / 3.0f;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const auto [at, added] = number.try_emplace(
                corners.find(3 * i + k), static_cast<std::uint32_t>(out.mesh.positions.size()));
            t[k] = at->second;
            if (!added) continue;
            const std::uint32_t v = triangles[i][k];
            const auto copy = static_cast<float>(copies[v]++);
            const Vec3f inwards = (centre - positions[v]).stableNormalized();
            out.mesh.positions.push_back(positions[v] + copy * kNudge * inwards);
        }
        out.mesh.triangles.push_back(t);
    }
}

} // namespace

MendedMesh mend(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                double weld_distance) {
    MendedMesh out;
    const auto leader = merge_near(positions, weld_distance, out.merged_vertices);
    std::vector<Triangle> kept;
    std::vector<Triangle> corners;
    std::set<Triangle> seen;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const Triangle t = {leader[triangles[i][0]], leader[triangles[i][1]],
                            leader[triangles[i][2]]};
        Triangle sorted = t;
        std::sort(sorted.begin(), sorted.end());
        const bool degenerate = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        if (degenerate || area(positions, t) < kLeastArea || !seen.insert(sorted).second) {
            ++out.dropped_triangles;
            continue;
        }
        kept.push_back(t);
        corners.push_back(triangles[i]);
    }
    out.turned_triangles = orient(kept, corners);
    sew(positions, kept, out);
    out.corners = std::move(corners);
    return out;
}

} // namespace toile::garment
