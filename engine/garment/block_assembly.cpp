#include "garment/block_assembly.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace toile::garment::block {
namespace {

class UnionFind {
  public:
    explicit UnionFind(const std::size_t n) : parent_(n) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    std::size_t find(std::size_t a) {
        while (parent_[a] != a) {
            parent_[a] = parent_[parent_[a]];
            a = parent_[a];
        }
        return a;
    }
    void join(const std::size_t a, const std::size_t b) {
        const std::size_t p = find(a);
        const std::size_t q = find(b);
        parent_[std::max(p, q)] = std::min(p, q);
    }

  private:
    std::vector<std::size_t> parent_;
};

std::size_t curve_index(const HalfPanel& panel, const std::string& name) {
    for (std::size_t i = 0; i < panel.border.size(); ++i) {
        if (panel.border[i].name == name) {
            return i;
        }
    }
    throw Error("panel '" + panel.name + "' of the pattern has no edge '" + name + "'");
}

// Sewn curves get equal numbers of edges: that of the mean length.
std::vector<std::vector<std::size_t>> count_pieces(const Pattern& pattern, const double edge_m) {
    std::vector<std::size_t> first;
    std::size_t total = 0;
    for (const HalfPanel& panel : pattern.panels) {
        first.push_back(total);
        total += panel.border.size();
    }
    UnionFind groups(total);
    for (const Seam& seam : pattern.seams) {
        const std::size_t a = pattern.panel_index(seam.panel_a);
        const std::size_t b = pattern.panel_index(seam.panel_b);
        groups.join(first[a] + curve_index(pattern.panels[a], seam.curve_a),
                    first[b] + curve_index(pattern.panels[b], seam.curve_b));
    }
    std::vector<double> sum(total, 0.0);
    std::vector<double> members(total, 0.0);
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        for (std::size_t c = 0; c < pattern.panels[p].border.size(); ++c) {
            const std::size_t group = groups.find(first[p] + c);
            sum[group] += length(pattern.panels[p].border[c].points);
            members[group] += 1.0;
        }
    }
    std::vector<std::vector<std::size_t>> pieces(pattern.panels.size());
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        for (std::size_t c = 0; c < pattern.panels[p].border.size(); ++c) {
            const std::size_t group = groups.find(first[p] + c);
            pieces[p].push_back(static_cast<std::size_t>(
                std::max(1.0, std::round(sum[group] / members[group] / edge_m))));
        }
    }
    return pieces;
}

std::vector<Vec2d> outline_of(const HalfPanel& panel, const std::span<const std::size_t> pieces) {
    std::vector<Vec2d> outline;
    for (std::size_t c = 0; c < panel.border.size(); ++c) {
        const std::vector<Vec2d> points = resample(panel.border[c].points, pieces[c]);
        outline.insert(outline.end(), points.begin(), points.end() - 1);
    }
    return outline;
}

// Flat vertices along one curve, ends included.
std::vector<std::uint32_t> along(const Assembly& assembly, const std::size_t panel,
                                 const std::size_t curve) {
    const auto& pieces = assembly.pieces[panel];
    const std::size_t start = std::accumulate(
        pieces.begin(), pieces.begin() + static_cast<std::ptrdiff_t>(curve), std::size_t{0});
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i <= pieces[curve]; ++i) {
        out.push_back(static_cast<std::uint32_t>((start + i) % assembly.flats[panel].border_count));
    }
    return out;
}

void weld(Assembly& assembly, const Pattern& pattern) {
    const std::size_t panels = pattern.panels.size();
    std::vector<std::size_t> first;
    std::size_t half = 0;
    for (const FlatMesh& flat : assembly.flats) {
        first.push_back(half);
        half += flat.points.size();
    }
    const std::size_t sides = assembly.sides;
    UnionFind same(sides * half);
    for (const Seam& seam : pattern.seams) {
        const std::size_t a = pattern.panel_index(seam.panel_a);
        const std::size_t b = pattern.panel_index(seam.panel_b);
        const auto va = along(assembly, a, curve_index(pattern.panels[a], seam.curve_a));
        auto vb = along(assembly, b, curve_index(pattern.panels[b], seam.curve_b));
        if (seam.reversed) {
            std::reverse(vb.begin(), vb.end());
        }
        for (std::size_t i = 0; i < va.size(); ++i) {
            same.join(first[a] + va[i], first[b] + vb[i]);
            if (sides == 2) {
                same.join(half + first[a] + va[i], half + first[b] + vb[i]);
            }
        }
    }
    for (const CentreSeam& centre : pattern.centres) {
        const std::size_t p = pattern.panel_index(centre.panel);
        for (const auto v : along(assembly, p, curve_index(pattern.panels[p], centre.curve))) {
            same.join(first[p] + v, half + first[p] + v);
        }
    }
    constexpr auto kUnset = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number(sides * half, kUnset);
    std::uint32_t count = 0;
    for (std::size_t side = 0; side < sides; ++side) {
        assembly.welded[side].resize(panels);
        for (std::size_t p = 0; p < panels; ++p) {
            for (std::size_t v = 0; v < assembly.flats[p].points.size(); ++v) {
                std::uint32_t& id = number[same.find(side * half + first[p] + v)];
                id = id == kUnset ? count++ : id;
                assembly.welded[side][p].push_back(id);
            }
        }
    }
    assembly.mirror.resize(count);
    for (std::size_t p = 0; p < panels; ++p) {
        for (std::size_t v = 0; v < assembly.flats[p].points.size(); ++v) {
            assembly.mirror[assembly.welded[0][p][v]] = assembly.welded[sides - 1][p][v];
            assembly.mirror[assembly.welded[sides - 1][p][v]] = assembly.welded[0][p][v];
        }
    }
}

bool runs_against_u(const HalfPanel& panel, const std::size_t side) {
    return panel.mirrored != (side == 1);
}

void collect_triangles(Assembly& assembly, const Pattern& pattern) {
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        for (std::size_t side = 0; side < assembly.sides; ++side) {
            for (Triangle t : assembly.flats[p].triangles) {
                if (runs_against_u(pattern.panels[p], side)) {
                    std::swap(t[1], t[2]);
                }
                const auto& welded = assembly.welded[side][p];
                // A corner whose two edges are sewn to each other folds flat.
                if (welded[t[0]] == welded[t[1]] || welded[t[1]] == welded[t[2]] ||
                    welded[t[2]] == welded[t[0]]) {
                    continue;
                }
                assembly.triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
                assembly.triangle_panel.push_back(static_cast<std::uint16_t>(p));
                assembly.triangle_side.push_back(static_cast<std::uint8_t>(side));
                assembly.triangle_flat.push_back(t);
            }
        }
    }
}

std::vector<Vec2d> grade_panel(const Assembly& assembly, const Pattern& pattern,
                               const std::size_t p) {
    const FlatMesh& base = assembly.flats[p];
    const std::vector<Vec2d> outline = outline_of(pattern.panels[p], assembly.pieces[p]);
    std::vector<Vec3d> move;
    for (std::size_t v = 0; v < outline.size(); ++v) {
        const Vec2d d = outline[v] - base.points[v];
        move.emplace_back(d.x(), d.y(), 0.0);
    }
    const std::vector<Vec3d> all = harmonic(base, move);
    std::vector<Vec2d> out;
    for (std::size_t v = 0; v < base.points.size(); ++v) {
        out.emplace_back(base.points[v] + all[v].head<2>());
    }
    for (const Triangle& t : base.triangles) {
        const Vec2d a = out[t[1]] - out[t[0]];
        const Vec2d b = out[t[2]] - out[t[0]];
        if (a.x() * b.y() - a.y() * b.x() <= 0.0) {
            throw Error("panel '" + pattern.panels[p].name +
                        "' folds over in this size: it is too unlike the base size");
        }
    }
    return out;
}

Vec3d mirrored(const Vec3d& p, const std::size_t side) {
    return side == 0 ? p : Vec3d(-p.x(), p.y(), p.z());
}

// Shared vertices take the place of the panel with the highest priority (the mean among equals);
// the other panels' inner vertices follow their moved borders.
std::vector<Vec3d> place(const Assembly& assembly, const Pattern& pattern,
                         const std::span<const std::vector<Vec2d>> flats) {
    std::vector<std::vector<Vec3d>> own(pattern.panels.size());
    for (std::size_t p = 0; p < own.size(); ++p) {
        for (const Vec2d& flat : flats[p]) {
            own[p].push_back(pattern.panels[p].place(flat));
        }
    }
    std::vector<Vec3d> sum(assembly.vertex_count(), Vec3d::Zero());
    std::vector<double> count(assembly.vertex_count(), 0.0);
    std::vector<int> priority(assembly.vertex_count(), std::numeric_limits<int>::min());
    for (std::size_t p = 0; p < own.size(); ++p) {
        for (std::size_t side = 0; side < assembly.sides; ++side) {
            for (std::size_t v = 0; v < own[p].size(); ++v) {
                const std::uint32_t id = assembly.welded[side][p][v];
                if (pattern.panels[p].priority > priority[id]) {
                    priority[id] = pattern.panels[p].priority;
                    sum[id].setZero();
                    count[id] = 0.0;
                }
                if (pattern.panels[p].priority == priority[id]) {
                    sum[id] += mirrored(own[p][v], side);
                    count[id] += 1.0;
                }
            }
        }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
        sum[v] /= count[v];
    }
    for (std::size_t p = 0; p < own.size(); ++p) {
        std::vector<Vec3d> move;
        for (std::size_t v = 0; v < assembly.flats[p].border_count; ++v) {
            move.emplace_back(sum[assembly.welded[0][p][v]] - own[p][v]);
        }
        const std::vector<Vec3d> all = harmonic(assembly.flats[p], move);
        for (std::size_t v = assembly.flats[p].border_count; v < own[p].size(); ++v) {
            for (std::size_t side = 0; side < assembly.sides; ++side) {
                sum[assembly.welded[side][p][v]] = mirrored(own[p][v] + all[v], side);
            }
        }
    }
    return sum;
}

} // namespace

Assembly assemble(const Pattern& base, const double edge_m) {
    Assembly assembly;
    assembly.edge_m = edge_m;
    assembly.sides = base.symmetric ? 2 : 1;
    assembly.pieces = count_pieces(base, edge_m);
    for (std::size_t p = 0; p < base.panels.size(); ++p) {
        const auto outline = outline_of(base.panels[p], assembly.pieces[p]);
        try {
            assembly.flats.push_back(triangulate(outline, edge_m));
        } catch (const Error& error) {
            throw Error("panel '" + base.panels[p].name + "': " + error.what());
        }
    }
    weld(assembly, base);
    collect_triangles(assembly, base);
    return assembly;
}

SizedBlock grade(const Assembly& assembly, const Pattern& pattern) {
    std::vector<std::vector<Vec2d>> flats;
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        flats.push_back(grade_panel(assembly, pattern, p));
    }
    SizedBlock out;
    out.positions = place(assembly, pattern, flats);
    for (std::size_t t = 0; t < assembly.triangles.size(); ++t) {
        const std::size_t p = assembly.triangle_panel[t];
        const std::size_t side = assembly.triangle_side[t];
        const HalfPanel& panel = pattern.panels[p];
        const double sign = runs_against_u(panel, side) ? -1.0 : 1.0;
        for (const std::uint32_t v : assembly.triangle_flat[t]) {
            const Vec2d flat = flats[p][v];
            const double shift = side == 1 ? panel.right_chart_shift : 0.0;
            out.material_coords.emplace_back(
                static_cast<float>(panel.chart_offset.x() + shift + sign * flat.x()),
                static_cast<float>(panel.chart_offset.y() + flat.y()));
        }
    }
    return out;
}

std::vector<std::uint32_t> edge_vertices(const Assembly& assembly, const Pattern& pattern,
                                         const int side, const std::string& panel,
                                         const std::string& curve) {
    const std::size_t p = pattern.panel_index(panel);
    std::vector<std::uint32_t> out;
    for (const auto v : along(assembly, p, curve_index(pattern.panels[p], curve))) {
        out.push_back(assembly.welded[static_cast<std::size_t>(side)][p][v]);
    }
    return out;
}

} // namespace toile::garment::block
