#include "geometry/level_surface.h"

#include "core/error.h"
#include "geometry/surface_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

namespace toile::geometry {
namespace {

constexpr std::size_t kMaxNodes = 200'000'000;

NodeField make_grid(const TriangleMesh& near, float spacing, float reach) {
    Eigen::AlignedBox3f box;
    for (const auto& p : near.positions)
        box.extend(p);
    NodeField grid;
    grid.spacing = spacing;
    const Vec3f margin = Vec3f::Constant(reach + 2.0f * spacing);
    for (int k = 0; k < 3; ++k) // nodes at multiples of the spacing, whatever the mesh
        grid.origin[k] = spacing * std::floor((box.min()[k] - margin[k]) / spacing);
    std::size_t nodes = 1;
    for (int k = 0; k < 3; ++k) {
        grid.size[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(
            std::ceil((box.max()[k] + margin[k] - grid.origin[k]) / spacing) + 1);
        nodes *= static_cast<std::size_t>(grid.size[static_cast<std::size_t>(k)]);
    }
    if (nodes > kMaxNodes) throw Error("the grid of a level surface would be too large");
    grid.values.assign(nodes, std::numeric_limits<float>::quiet_NaN());
    return grid;
}

/// Marks, then samples, the nodes in every triangle's box grown by `reach`.
void sample(NodeField& grid, const TriangleMesh& near,
            const std::function<float(const Vec3f&)>& reach_at,
            const std::function<float(const Vec3f&)>& value) {
    std::vector<bool> marked(grid.values.size());
    for (const auto& t : near.triangles) {
        Eigen::AlignedBox3f box;
        float reach = 0.0f;
        for (const auto v : t) {
            box.extend(near.positions[v]);
            reach = std::max(reach, reach_at(near.positions[v]));
        }
        std::array<std::int64_t, 3> low{}, high{};
        for (int k = 0; k < 3; ++k) {
            const auto i = static_cast<std::size_t>(k);
            low[i] = static_cast<std::int64_t>(
                std::ceil((box.min()[k] - reach - grid.origin[k]) / grid.spacing));
            high[i] = static_cast<std::int64_t>(
                std::floor((box.max()[k] + reach - grid.origin[k]) / grid.spacing));
        }
        for (auto z = low[2]; z <= high[2]; ++z)
            for (auto y = low[1]; y <= high[1]; ++y)
                for (auto x = low[0]; x <= high[0]; ++x)
                    marked[static_cast<std::size_t>(grid.index(x, y, z))] = true;
    }
    for (std::size_t i = 0; i < marked.size(); ++i)
        if (marked[i]) grid.values[i] = value(grid.position(static_cast<std::int64_t>(i)));
}

/// Collects the triangles of one tetrahedron after another, welding along grid edges.
class Marcher {
  public:
    explicit Marcher(const NodeField& grid) : grid_(grid) {}

    /// `corners`: node indices of a tetrahedron, positively oriented when `even`.
    void tetrahedron(std::array<std::int64_t, 4> corners, bool even) {
        std::array<std::int64_t, 4> c{};
        std::size_t inside = 0;
        for (const auto corner : corners)
            inside += value(corner) < 0.0f ? 1 : 0;
        if (inside == 0 || inside == 4) return;
        // Stable partition, inner corners first, by swaps of neighbours that keep the parity.
        c = corners;
        for (std::size_t pass = 0; pass < 3; ++pass)
            for (std::size_t i = 0; i < 3; ++i)
                if (value(c[i]) >= 0.0f && value(c[i + 1]) < 0.0f) {
                    std::swap(c[i], c[i + 1]);
                    even = !even;
                }
        if (inside == 1) add({cut(c[0], c[1]), cut(c[0], c[2]), cut(c[0], c[3])}, even);
        if (inside == 3) add({cut(c[0], c[3]), cut(c[1], c[3]), cut(c[2], c[3])}, even);
        if (inside == 2) {
            const auto p = cut(c[0], c[2]), q = cut(c[0], c[3]), r = cut(c[1], c[3]);
            add({p, q, r}, even);
            add({p, r, cut(c[1], c[2])}, even);
        }
    }

    TriangleMesh mesh;

  private:
    [[nodiscard]] float value(std::int64_t node) const {
        const float v = grid_.values[static_cast<std::size_t>(node)];
        const float least = 1e-5f * grid_.spacing; // a node exactly on the surface would pinch it
        return std::abs(v) < least ? least : v;
    }
    void add(Triangle t, bool even) {
        if (!even) std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
    }
    std::uint32_t cut(std::int64_t a, std::int64_t b) {
        if (a > b) std::swap(a, b);
        const auto key =
            static_cast<std::uint64_t>(a) * grid_.values.size() + static_cast<std::uint64_t>(b);
        const auto [found, added] =
            cuts_.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added) {
            const float va = value(a), vb = value(b), t = va / (va - vb);
            mesh.positions.emplace_back((1.0f - t) * grid_.position(a) + t * grid_.position(b));
        }
        return found->second;
    }

    const NodeField& grid_;
    std::unordered_map<std::uint64_t, std::uint32_t> cuts_; // looked up only, never walked
};

/// Corner masks of the six tetrahedra around a cube's diagonal, with their orientation.
struct CubeTetrahedron {
    std::array<int, 4> corners;
    bool even;
};
constexpr std::array<CubeTetrahedron, 6> kTetrahedra = {{{{0, 1, 3, 7}, true},
                                                         {{0, 2, 6, 7}, true},
                                                         {{0, 4, 5, 7}, true},
                                                         {{0, 1, 5, 7}, false},
                                                         {{0, 2, 3, 7}, false},
                                                         {{0, 4, 6, 7}, false}}};

} // namespace

TriangleMesh level_surface(const TriangleMesh& near, float spacing,
                           const std::function<float(const Vec3f&)>& reach,
                           const std::function<float(const Vec3f&)>& value) {
    float farthest = 0.0f;
    for (const auto& p : near.positions)
        farthest = std::max(farthest, reach(p));
    NodeField grid = make_grid(near, spacing, farthest);
    sample(grid, near, reach, value);
    return level_surface(grid);
}

TriangleMesh level_surface(const NodeField& grid) {
    Marcher marcher(grid);
    for (std::int64_t z = 0; z + 1 < grid.size[2]; ++z)
        for (std::int64_t y = 0; y + 1 < grid.size[1]; ++y)
            for (std::int64_t x = 0; x + 1 < grid.size[0]; ++x) {
                std::array<std::int64_t, 8> nodes{};
                bool negative = false, positive = false, known = true;
                for (std::size_t k = 0; k < 8 && known; ++k) {
                    nodes[k] = grid.index(x + static_cast<std::int64_t>(k & 1),
                                          y + static_cast<std::int64_t>((k >> 1) & 1),
                                          z + static_cast<std::int64_t>(k >> 2));
                    const float v = grid.values[static_cast<std::size_t>(nodes[k])];
                    known = !std::isnan(v);
                    (v < -1e-5f * grid.spacing ? negative : positive) = true;
                }
                if (!known || !negative || !positive) continue;
                for (const auto& t : kTetrahedra)
                    marcher.tetrahedron({nodes[static_cast<std::size_t>(t.corners[0])],
                                         nodes[static_cast<std::size_t>(t.corners[1])],
                                         nodes[static_cast<std::size_t>(t.corners[2])],
                                         nodes[static_cast<std::size_t>(t.corners[3])]},
                                        t.even);
            }
    return std::move(marcher.mesh);
}

std::vector<TriangleMesh> connected_pieces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> root(mesh.positions.size());
    for (std::uint32_t v = 0; v < root.size(); ++v)
        root[v] = v;
    const auto find = [&](std::uint32_t v) {
        while (root[v] != v)
            v = root[v] = root[root[v]];
        return v;
    };
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 1; k < 3; ++k) {
            const auto a = find(t[0]), b = find(t[k]);
            root[std::max(a, b)] = std::min(a, b);
        }
    constexpr auto kNew = std::numeric_limits<std::uint32_t>::max();
    std::map<std::uint32_t, std::size_t> piece_of_root;
    std::vector<std::uint32_t> vertex(mesh.positions.size(), kNew);
    std::vector<TriangleMesh> out;
    for (const auto& t : mesh.triangles) {
        const auto [found, added] = piece_of_root.try_emplace(find(t[0]), out.size());
        if (added) out.emplace_back();
        TriangleMesh& piece = out[found->second];
        Triangle moved{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (vertex[t[k]] == kNew) {
                vertex[t[k]] = static_cast<std::uint32_t>(piece.positions.size());
                piece.positions.push_back(mesh.positions[t[k]]);
            }
            moved[k] = vertex[t[k]];
        }
        piece.triangles.push_back(moved);
    }
    return out;
}

TriangleMesh closed_outer_surface(const TriangleMesh& mesh, float spacing,
                                  const std::function<float(const Vec3f&)>& radius) {
    const auto offset = [&](const TriangleMesh& from) {
        const auto reach = [&](const Vec3f& p) { return radius(p) + 2.0f * spacing; };
        const SurfaceProbe nearest(from.positions, from.triangles);
        return connected_pieces(level_surface(from, spacing, reach, [&](const Vec3f& p) {
            return nearest.distance(p, 3.0f * reach(p)) - radius(p);
        }));
    };
    const auto by_volume = [](const TriangleMesh& a, const TriangleMesh& b) {
        return volume(a) < volume(b);
    };
    const auto grown = offset(mesh);
    if (grown.empty()) throw Error("a closed outer surface needs a mesh with triangles");
    const auto shells = offset(*std::max_element(grown.begin(), grown.end(), by_volume));
    // The inner side of the shell faces inwards, so its volume is the most negative.
    TriangleMesh out = *std::min_element(shells.begin(), shells.end(), by_volume);
    if (volume(out) >= 0.0)
        throw Error("a closed outer surface vanished: it is thinner than the radius");
    for (auto& t : out.triangles)
        std::swap(t[1], t[2]);
    return out;
}

TriangleMesh clip_to_left_half(const TriangleMesh& mesh) {
    TriangleMesh out;
    constexpr auto kNew = std::numeric_limits<std::uint32_t>::max();
    constexpr float kOnPlane = 1e-6f;
    std::vector<std::uint32_t> kept(mesh.positions.size(), kNew);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cuts;
    const auto x = [&](std::uint32_t v) {
        const float value = mesh.positions[v].x();
        return std::abs(value) < kOnPlane ? 0.0f : value;
    };
    const auto keep = [&](std::uint32_t v) {
        if (kept[v] == kNew) {
            kept[v] = static_cast<std::uint32_t>(out.positions.size());
            out.positions.emplace_back(x(v), mesh.positions[v].y(), mesh.positions[v].z());
        }
        return kept[v];
    };
    const auto cut = [&](std::uint32_t a, std::uint32_t b) {
        if (a > b) std::swap(a, b);
        const auto [found, added] =
            cuts.try_emplace({a, b}, static_cast<std::uint32_t>(out.positions.size()));
        if (added) {
            const float t = x(a) / (x(a) - x(b));
            Vec3f p = (1.0f - t) * mesh.positions[a] + t * mesh.positions[b];
            p.x() = 0.0f;
            out.positions.push_back(p);
        }
        return found->second;
    };
    for (const auto& t : mesh.triangles) {
        std::vector<std::uint32_t> polygon;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = t[k], b = t[(k + 1) % 3];
            if (x(a) >= 0.0f) polygon.push_back(keep(a));
            if ((x(a) < 0.0f && x(b) > 0.0f) || (x(a) > 0.0f && x(b) < 0.0f))
                polygon.push_back(cut(a, b));
        }
        const auto on_plane = [&](std::uint32_t v) { return out.positions[v].x() == 0.0f; };
        if (std::all_of(polygon.begin(), polygon.end(), on_plane)) continue;
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
            out.triangles.push_back({polygon[0], polygon[k], polygon[k + 1]});
    }
    return out;
}

} // namespace toile::geometry
