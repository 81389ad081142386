// check_topology: counts what keeps a triangle soup from being a closed, oriented 2-manifold.
#include "geometry/mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace toile::geometry {
namespace {

// One side of one triangle; sorting brings the sides of an edge together.
struct Side {
    std::uint32_t low, high;
    std::uint32_t triangle;
    bool forward; // runs from low to high

    bool operator<(const Side& other) const {
        return std::tie(low, high, triangle, forward) <
               std::tie(other.low, other.high, other.triangle, other.forward);
    }
};

class UnionFind {
  public:
    explicit UnionFind(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t i) {
        while (parents_[i] != i) {
            parents_[i] = parents_[parents_[i]];
            i = parents_[i];
        }
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { parents_[find(a)] = find(b); }

  private:
    std::vector<std::uint32_t> parents_;
};

bool degenerate(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

std::vector<Side> sorted_sides(std::span<const Triangle> triangles,
                               const std::vector<char>& valid) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        if (valid[i] == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[i][k];
            const std::uint32_t b = triangles[i][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), i, a < b});
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

// Corners of two triangles on a common edge belong to one fan at each end of it.
std::uint32_t corner_of(const Triangle& t, std::uint32_t triangle, std::uint32_t vertex) {
    const std::uint32_t k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    return 3 * triangle + k;
}

void check_edges(std::span<const Triangle> triangles, const std::vector<Side>& sides,
                 UnionFind& pieces, UnionFind& fans, TopologyReport& report) {
    for (std::size_t begin = 0; begin < sides.size();) {
        std::size_t end = begin;
        std::size_t forward = 0;
        const Side& first = sides[begin];
        for (; end < sides.size() && sides[end].low == first.low && sides[end].high == first.high;
             ++end) {
            forward += sides[end].forward ? 1 : 0;
            const std::uint32_t a = first.triangle;
            const std::uint32_t b = sides[end].triangle;
            pieces.join(a, b);
            for (const std::uint32_t v : {first.low, first.high})
                fans.join(corner_of(triangles[a], a, v), corner_of(triangles[b], b, v));
        }
        const std::size_t count = end - begin;
        if (count == 1) ++report.boundary_edges;
        if (count > 2) ++report.non_manifold_edges;
        if (count == 2 && forward != 1) ++report.misoriented_edges;
        begin = end;
    }
}

// A vertex is manifold when all corners at it are in one fan.
std::size_t vertices_with_several_fans(std::size_t vertex_count,
                                       std::span<const Triangle> triangles,
                                       const std::vector<char>& valid, UnionFind& fans) {
    constexpr std::uint32_t kUnseen = 0xffffffffu;
    std::vector<std::uint32_t> fan(vertex_count, kUnseen);
    std::vector<char> several(vertex_count, 0);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        if (valid[i] == 0) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t v = triangles[i][k];
            const std::uint32_t root = fans.find(3 * i + k);
            if (fan[v] == kUnseen) fan[v] = root;
            if (fan[v] != root) several[v] = 1;
        }
    }
    return static_cast<std::size_t>(std::count(several.begin(), several.end(), 1));
}

} // namespace

TopologyReport check_topology(std::span<const Vec3f> positions,
                              std::span<const Triangle> triangles) {
    TopologyReport report;
    for (const Vec3f& p : positions)
        if (!p.allFinite()) ++report.non_finite;

    std::vector<char> valid(triangles.size(), 0);
    std::vector<char> used(positions.size(), 0);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        if (*std::max_element(t.begin(), t.end()) >= positions.size()) {
            ++report.out_of_range;
            continue;
        }
        for (const std::uint32_t v : t)
            used[v] = 1;
        if (degenerate(t))
            ++report.degenerate;
        else
            valid[i] = 1;
    }
    report.unused_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));

    UnionFind pieces(triangles.size());
    UnionFind fans(3 * triangles.size());
    check_edges(triangles, sorted_sides(triangles, valid), pieces, fans, report);
    report.non_manifold_vertices =
        vertices_with_several_fans(positions.size(), triangles, valid, fans);
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        if (valid[i] != 0 && pieces.find(i) == i) ++report.components;
    return report;
}

std::string TopologyReport::text() const {
    if (manifold()) return "";
    std::string text;
    const auto add = [&text](std::size_t count, const char* what) {
        if (count == 0) return;
        if (!text.empty()) text += ", ";
        text += std::to_string(count) + " " + what;
    };
    add(out_of_range, "triangle(s) with an index out of range");
    add(non_finite, "vertex(es) that are not finite");
    add(degenerate, "triangle(s) that name a vertex twice");
    add(non_manifold_edges, "edge(s) with more than two triangles");
    add(misoriented_edges, "edge(s) whose triangles disagree on the outside");
    add(non_manifold_vertices, "vertex(es) where several fans of triangles meet");
    return text;
}

} // namespace toile::geometry
