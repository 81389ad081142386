#include "geometry/clean_up_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <unordered_map>

namespace toile::geometry {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A triangle's side: its ends, lower first, and where it stands.
struct Side {
    std::uint32_t a, b;
    std::uint32_t triangle;
    std::uint8_t forward; ///< run through from a to b
};

/// All sides, those of one edge together.
std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
    std::vector<Side> out;
    out.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[i][k], b = triangles[i][(k + 1) % 3];
            out.push_back({std::min(a, b), std::max(a, b), i, static_cast<std::uint8_t>(a < b)});
        }
    std::sort(out.begin(), out.end(), [](const Side& x, const Side& y) {
        return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
    });
    return out;
}

/// Calls work(first, last) for the sides of each edge.
template <class Work>
void each_edge(const std::vector<Side>& sides, const Work& work) {
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i + 1;
        while (j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b)
            ++j;
        work(i, j);
        i = j;
    }
}

Vec3f normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return (mesh.positions[t[1]] - mesh.positions[t[0]])
        .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
        .normalized();
}

/// Removes the triangles that are marked.
std::size_t drop(std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& marked) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (marked[i] == 0) triangles[kept++] = triangles[i];
    const std::size_t dropped = triangles.size() - kept;
    triangles.resize(kept);
    return dropped;
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

/// Points that no triangle uses are left out.
void drop_unused(CleanMesh& out) {
    std::vector<std::uint32_t> place(out.mesh.positions.size(), kNone);
    std::uint32_t next = 0;
    for (const Triangle& t : out.mesh.triangles)
        for (const std::uint32_t v : t)
            place[v] = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == kNone) continue;
        out.mesh.positions[next] = out.mesh.positions[v];
        out.source[next] = out.source[v];
        place[v] = next++;
    }
    out.mesh.positions.resize(next);
    out.source.resize(next);
    for (Triangle& t : out.mesh.triangles)
        for (std::uint32_t& v : t)
            v = place[v];
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

/// Ear by ear, always the shortest next diagonal that is no edge yet; where none is left, around a
/// new point in the middle.
void close_hole(std::vector<std::uint32_t> loop, std::set<Edge>& edges, CleanMesh& out) {
    auto& mesh = out.mesh;
    while (loop.size() > 3) {
        const std::size_t n = loop.size();
        std::size_t best = n;
        float shortest = std::numeric_limits<float>::max();
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t a = loop[(i + n - 1) % n], b = loop[(i + 1) % n];
            const float d = (mesh.positions[a] - mesh.positions[b]).squaredNorm();
            if (d >= shortest || edges.contains(edge_of(a, b))) continue;
            shortest = d;
            best = i;
        }
        if (best == n) break;
        const std::uint32_t a = loop[(best + n - 1) % n], b = loop[(best + 1) % n];
        edges.insert(edge_of(a, b));
        mesh.triangles.push_back({a, loop[best], b});
        loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
    }
    if (loop.size() == 3) {
        mesh.triangles.push_back({loop[0], loop[1], loop[2]});
        return;
    }
    Vec3f middle = Vec3f::Zero();
    for (const std::uint32_t v : loop)
        middle += mesh.positions[v] / static_cast<float>(loop.size());
    const auto centre = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(middle);
    out.source.push_back(out.source[loop[0]]);
    for (std::size_t i = 0; i < loop.size(); ++i)
        mesh.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
}

} // namespace

void merge_points(const TriangleMesh& scan, float radius, CleanMesh& out) {
    // Cells of the radius; a point joins the first one within reach in the cells around it.
    const float cell = std::max(radius, 1e-9f);
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
    cells.reserve(scan.positions.size());
    const auto key = [](std::int64_t x, std::int64_t y, std::int64_t z) {
        return static_cast<std::uint64_t>(x * 73856093) ^ static_cast<std::uint64_t>(y * 19349663) ^
               static_cast<std::uint64_t>(z * 83492791);
    };
    std::vector<std::uint32_t> place(scan.positions.size(), kNone);
    for (std::uint32_t v = 0; v < place.size(); ++v) {
        const Vec3f& p = scan.positions[v];
        if (!p.allFinite() || p.cwiseAbs().maxCoeff() > 1e6f) continue;
        std::array<std::int64_t, 3> at{};
        for (int k = 0; k < 3; ++k)
            at[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / cell));
        for (int n = 0; n < 27 && place[v] == kNone; ++n) {
            const auto found =
                cells.find(key(at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1));
            if (found == cells.end()) continue;
            for (const std::uint32_t other : found->second)
                if ((out.mesh.positions[other] - p).norm() <= radius) {
                    place[v] = other;
                    break;
                }
        }
        if (place[v] != kNone) {
            ++out.report.merged_points;
            continue;
        }
        place[v] = static_cast<std::uint32_t>(out.mesh.positions.size());
        cells[key(at[0], at[1], at[2])].push_back(place[v]);
        out.mesh.positions.push_back(p);
        out.source.push_back(v);
    }
    for (const Triangle& t : scan.triangles) {
        const bool usable = std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
            return v < place.size() && place[v] != kNone;
        });
        if (usable)
            out.mesh.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
        else
            ++out.report.dropped_triangles;
    }
}

void drop_bad_triangles(CleanMesh& out) {
    auto& triangles = out.mesh.triangles;
    std::vector<std::uint8_t> bad(triangles.size(), 0);
    std::vector<std::pair<Triangle, std::uint32_t>> sorted;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        Triangle t = triangles[i];
        std::sort(t.begin(), t.end());
        bad[i] = t[0] == t[1] || t[1] == t[2] ? 1 : 0;
        sorted.emplace_back(t, i);
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i].first == sorted[i - 1].first) bad[sorted[i].second] = 1;
    out.report.dropped_triangles += drop(triangles, bad);
}

void drop_extra_at_edges(CleanMesh& out) {
    const TriangleMesh& mesh = out.mesh;
    const auto sides = sorted_sides(mesh.triangles);
    std::vector<std::uint8_t> extra(mesh.triangles.size(), 0);
    each_edge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first <= 2) return;
        ++out.report.non_manifold_edges;
        float best = -2.0f;
        std::array<std::size_t, 2> keep = {first, first + 1};
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = i + 1; j < last; ++j) {
                // Two that run through the edge the same way face each other's backs.
                const float sign = sides[i].forward == sides[j].forward ? -1.0f : 1.0f;
                const float smooth =
                    sign *
                    normal_of(mesh, sides[i].triangle).dot(normal_of(mesh, sides[j].triangle));
                if (smooth <= best) continue;
                best = smooth;
                keep = {i, j};
            }
        for (std::size_t i = first; i < last; ++i)
            if (i != keep[0] && i != keep[1]) extra[sides[i].triangle] = 1;
    });
    out.report.dropped_triangles += drop(out.mesh.triangles, extra);
}

void orient_alike(CleanMesh& out) {
    auto& triangles = out.mesh.triangles;
    const auto sides = sorted_sides(triangles);
    std::vector<std::array<std::pair<std::uint32_t, std::uint8_t>, 3>> beside(
        triangles.size(), {{{kNone, 0}, {kNone, 0}, {kNone, 0}}});
    std::vector<std::uint8_t> filled(triangles.size(), 0);
    each_edge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first != 2) return;
        const Side &x = sides[first], &y = sides[first + 1];
        const std::uint8_t alike = x.forward != y.forward ? 1 : 0;
        beside[x.triangle][filled[x.triangle]++] = {y.triangle, alike};
        beside[y.triangle][filled[y.triangle]++] = {x.triangle, alike};
    });
    std::vector<std::uint8_t> state(triangles.size(), 0); // 0 unseen, 1 kept, 2 turned
    std::vector<std::uint8_t> bad(triangles.size(), 0);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
        if (state[seed] != 0) continue;
        state[seed] = 1;
        queue.assign(1, seed);
        for (std::size_t at = 0; at < queue.size(); ++at)
            for (const auto& [next, alike] : beside[queue[at]]) {
                if (next == kNone) continue;
                const std::uint8_t wanted =
                    alike != 0 ? state[queue[at]] : static_cast<std::uint8_t>(3 - state[queue[at]]);
                if (state[next] == 0) {
                    state[next] = wanted;
                    queue.push_back(next);
                } else if (state[next] != wanted) {
                    bad[next] = 1; // a one-sided piece
                }
            }
    }
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (state[i] == 2) std::swap(triangles[i][1], triangles[i][2]);
    out.report.dropped_triangles += drop(triangles, bad);
}

void keep_largest_piece(CleanMesh& out) {
    auto& triangles = out.mesh.triangles;
    std::vector<std::uint32_t> parent(triangles.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto sides = sorted_sides(triangles);
    each_edge(sides, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first + 1; i < last; ++i) {
            const auto a = root(parent, sides[first].triangle), b = root(parent, sides[i].triangle);
            parent[std::max(a, b)] = std::min(a, b);
        }
    });
    std::vector<std::size_t> sizes(triangles.size(), 0);
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        ++sizes[root(parent, i)];
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    std::vector<std::uint8_t> other(triangles.size(), 0);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        other[i] = root(parent, i) == largest ? 0 : 1;
        if (other[i] != 0 && parent[i] == i) ++out.report.dropped_pieces;
    }
    drop(triangles, other);
    drop_unused(out);
}

void split_pinched_vertices(CleanMesh& out) {
    auto& mesh = out.mesh;
    const auto around = vertex_triangles(mesh.positions.size(), mesh.triangles);
    const std::size_t count = mesh.positions.size();
    for (std::uint32_t v = 0; v < count; ++v) {
        std::vector<std::uint32_t> left(
            around.neighbours.begin() + static_cast<std::ptrdiff_t>(around.first[v]),
            around.neighbours.begin() + static_cast<std::ptrdiff_t>(around.first[v + 1]));
        for (bool first = true; !left.empty(); first = false) {
            std::vector<std::uint32_t> fan = {left.back()};
            left.pop_back();
            for (std::size_t at = 0; at < fan.size(); ++at)
                for (std::size_t i = 0; i < left.size();) {
                    std::size_t shared = 0;
                    for (const auto a : mesh.triangles[fan[at]])
                        for (const auto b : mesh.triangles[left[i]])
                            shared += a == b ? 1 : 0;
                    if (shared < 2) {
                        ++i;
                        continue;
                    }
                    fan.push_back(left[i]);
                    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
                }
            if (first) continue;
            const auto copy = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(mesh.positions[v]);
            out.source.push_back(out.source[v]);
            for (const std::uint32_t t : fan)
                std::replace(mesh.triangles[t].begin(), mesh.triangles[t].end(), v, copy);
        }
    }
}

void fill_holes(std::size_t largest, CleanMesh& out) {
    auto& mesh = out.mesh;
    const auto sides = sorted_sides(mesh.triangles);
    std::set<Edge> edges; // of the borders' surroundings
    // Runs along the border, against the triangles there.
    std::vector<std::uint32_t> next(mesh.positions.size(), kNone);
    each_edge(sides, [&](std::size_t first, std::size_t last) {
        if (last - first != 1) return;
        const Side& s = sides[first];
        const auto [from, to] = s.forward != 0 ? std::pair(s.b, s.a) : std::pair(s.a, s.b);
        next[from] = to;
    });
    for (const Side& side : sides)
        if (next[side.a] != kNone && next[side.b] != kNone) edges.emplace(side.a, side.b);
    for (std::uint32_t start = 0; start < next.size(); ++start) {
        if (next[start] == kNone) continue;
        std::vector<std::uint32_t> loop;
        for (std::uint32_t v = start; next[v] != kNone;) {
            loop.push_back(v);
            const std::uint32_t to = next[v];
            next[v] = kNone;
            v = to;
        }
        if (loop.size() < 3 || loop.size() > largest) {
            ++out.report.open_holes;
            continue;
        }
        ++out.report.filled_holes;
        close_hole(std::move(loop), edges, out);
    }
}

} // namespace toile::geometry
