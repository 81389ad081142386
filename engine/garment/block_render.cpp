#include "garment/block_render.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile::garment::block {
namespace {

// A mesh under refinement: welded positions and normals, texture metres per corner.
struct Surface {
    std::vector<Vec3d> positions, normals;
    std::vector<Triangle> triangles;
    std::vector<std::array<Vec2d, 3>> coords; // (nf)
    std::vector<std::uint16_t> panels;        // (nf)
    std::vector<std::uint8_t> sides;          // (nf)
};

std::vector<Vec3d> smooth_normals(const Surface& s) {
    std::vector<Vec3d> normals(s.positions.size(), Vec3d::Zero());
    for (const Triangle& t : s.triangles) {
        const Vec3d n =
            (s.positions[t[1]] - s.positions[t[0]]).cross(s.positions[t[2]] - s.positions[t[0]]);
        for (const std::uint32_t v : t) {
            normals[v] += n;
        }
    }
    for (Vec3d& n : normals) {
        n.normalize();
    }
    return normals;
}

Surface refine(const Surface& coarse) {
    Surface fine;
    fine.positions = coarse.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](const std::uint32_t a, const std::uint32_t b) {
        const auto [it, inserted] = middles.try_emplace(
            std::minmax(a, b), static_cast<std::uint32_t>(fine.positions.size()));
        if (inserted) {
            const Vec3d along = coarse.positions[b] - coarse.positions[a];
            const Vec3d& na = coarse.normals[a];
            const Vec3d& nb = coarse.normals[b];
            fine.positions.emplace_back(0.5 * (coarse.positions[a] + coarse.positions[b]) -
                                        (along.dot(na) * na - along.dot(nb) * nb) / 8.0);
        }
        return it->second;
    };
    for (std::size_t f = 0; f < coarse.triangles.size(); ++f) {
        const Triangle& t = coarse.triangles[f];
        const auto& c = coarse.coords[f];
        const Triangle m = {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
        const std::array<Vec2d, 3> mc = {0.5 * (c[0] + c[1]), 0.5 * (c[1] + c[2]),
                                         0.5 * (c[2] + c[0])};
        fine.triangles.insert(
            fine.triangles.end(),
            {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}});
        fine.coords.insert(fine.coords.end(), {{c[0], mc[0], mc[2]},
                                               {mc[0], c[1], mc[1]},
                                               {mc[2], mc[1], c[2]},
                                               {mc[0], mc[1], mc[2]}});
        fine.panels.insert(fine.panels.end(), 4, coarse.panels[f]);
        fine.sides.insert(fine.sides.end(), 4, coarse.sides[f]);
    }
    fine.normals = smooth_normals(fine);
    return fine;
}

// Free edges, as half-edges (triangle, corner at which they start).
std::vector<std::pair<std::size_t, int>> free_edges(const Surface& s) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, std::pair<std::size_t, int>>>
        edges;
    for (std::size_t f = 0; f < s.triangles.size(); ++f) {
        for (int k = 0; k < 3; ++k) {
            auto& [count, where] =
                edges[std::minmax(s.triangles[f][k], s.triangles[f][(k + 1) % 3])];
            ++count;
            where = {f, k};
        }
    }
    std::vector<std::pair<std::size_t, int>> out;
    for (const auto& [edge, value] : edges) {
        if (value.first == 1) {
            out.push_back(value.second);
        }
    }
    return out;
}

// Adds the strip that turns in at free edges of panels of the part.
void turn_in(Surface& s, const double width, const double thickness,
             const std::vector<bool>& in_part) {
    const auto edges = free_edges(s);
    // Into the cloth, along the surface, at each border vertex.
    std::map<std::uint32_t, Vec3d> inward;
    for (const auto& [f, k] : edges) {
        const Triangle& t = s.triangles[f];
        const std::uint32_t a = t[k];
        const std::uint32_t b = t[(k + 1) % 3];
        const Vec3d along = s.positions[b] - s.positions[a];
        const Vec3d normal = (s.normals[a] + s.normals[b]).normalized();
        const Vec3d in = normal.cross(along);
        inward.try_emplace(a, Vec3d::Zero()).first->second += in;
        inward.try_emplace(b, Vec3d::Zero()).first->second += in;
    }
    std::map<std::uint32_t, std::array<std::uint32_t, 2>> rows;
    for (auto& [v, in] : inward) {
        const auto first = static_cast<std::uint32_t>(s.positions.size());
        const Vec3d p = s.positions[v] - thickness * s.normals[v];
        s.positions.push_back(p);
        s.positions.emplace_back(p + width * in.normalized());
        rows[v] = {first, first + 1};
    }
    for (const auto& [f, k] : edges) {
        if (!in_part[s.panels[f]]) {
            continue;
        }
        const std::uint32_t a = s.triangles[f][k];
        const std::uint32_t b = s.triangles[f][(k + 1) % 3];
        const Vec2d ca = s.coords[f][k];
        const Vec2d cb = s.coords[f][(k + 1) % 3];
        const Vec2d across(-(cb - ca).y(), (cb - ca).x());
        const Vec2d in = across.normalized() * width;
        const auto& ra = rows[a];
        const auto& rb = rows[b];
        s.triangles.insert(
            s.triangles.end(),
            {{b, a, ra[0]}, {b, ra[0], rb[0]}, {rb[0], ra[0], ra[1]}, {rb[0], ra[1], rb[1]}});
        s.coords.insert(s.coords.end(), {{cb, ca, ca},
                                         {cb, ca, cb},
                                         {cb, ca, Vec2d(ca + in)},
                                         {cb, Vec2d(ca + in), Vec2d(cb + in)}});
        s.panels.insert(s.panels.end(), 4, std::uint16_t(s.panels[f]));
        s.sides.insert(s.sides.end(), 4, std::uint8_t(s.sides[f]));
    }
}

assets::Primitive cut(const Surface& s, const std::vector<bool>& in_part, const double tile) {
    assets::Primitive out;
    // Cut between pieces of cloth, so that all sizes are cut alike.
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
    for (std::size_t f = 0; f < s.triangles.size(); ++f) {
        if (!in_part[s.panels[f]]) {
            continue;
        }
        Triangle t{};
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = s.triangles[f][k];
            const Vec3f p = s.positions[v].cast<float>();
            const Vec2f uv(static_cast<float>(s.coords[f][k].x() / tile),
                           static_cast<float>(-s.coords[f][k].y() / tile));
            const auto [it, inserted] = numbers.try_emplace(
                {v, s.panels[f], s.sides[f]}, static_cast<std::uint32_t>(out.positions.size()));
            if (inserted) {
                out.positions.push_back(p);
                out.normals.push_back(s.normals[v].cast<float>());
                out.texcoords.push_back(uv);
            }
            t[k] = it->second;
        }
        out.triangles.push_back(t);
    }
    return out;
}

} // namespace

std::vector<assets::Primitive> render_parts(const Assembly& assembly, const Pattern& pattern,
                                            const SizedBlock& block,
                                            const std::span<const RenderPart> parts,
                                            const double thickness_m) {
    Surface surface;
    surface.positions = block.positions;
    surface.triangles = assembly.triangles;
    surface.panels = assembly.triangle_panel;
    surface.sides = assembly.triangle_side;
    for (std::size_t f = 0; f < assembly.triangles.size(); ++f) {
        const HalfPanel& panel = pattern.panels[assembly.triangle_panel[f]];
        std::array<Vec2d, 3> c;
        for (std::size_t k = 0; k < 3; ++k) {
            c[k] = block.material_coords[3 * f + k].cast<double>();
            if (panel.unroll) {
                c[k] = panel.unroll(c[k] - panel.chart_offset);
            }
        }
        surface.coords.push_back(c);
    }
    surface.normals = smooth_normals(surface);
    const Surface fine = refine(surface);
    std::vector<assets::Primitive> out;
    for (const RenderPart& part : parts) {
        std::vector<bool> in_part(pattern.panels.size(), false);
        for (const std::uint16_t p : part.panels) {
            in_part[p] = true;
        }
        Surface drawn = fine;
        if (part.turn_in_m > 0.0) {
            turn_in(drawn, part.turn_in_m, thickness_m, in_part);
            drawn.normals = smooth_normals(drawn);
        }
        out.push_back(cut(drawn, in_part, part.tile_m));
    }
    return out;
}

} // namespace toile::garment::block
