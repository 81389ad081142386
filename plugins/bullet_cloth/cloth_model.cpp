#include "bullet_cloth/cloth_model.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::bullet_cloth {
namespace {

/// A triangle's side as seen from that triangle.
struct HalfEdge {
    std::uint32_t a, b;     ///< a < b
    std::uint32_t opposite; ///< third vertex
    float length;           ///< m, of the material
    float height;           ///< m, of `opposite` above the side
    float foot;             ///< m, from a to the foot of that height
    float area;             ///< m^2, of the triangle
    float stiffness;        ///< N/m, membrane stiffness along the side
    float rigidity;         ///< N m, bending about the side
};

std::vector<HalfEdge> half_edges(const ClothMesh& mesh, const Fabric& fabric, ClothModel& model) {
    std::vector<HalfEdge> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<Vec2f, 3> corner = cloth::material_corners(mesh, t);
        const Vec2f u = corner[1] - corner[0];
        const Vec2f v = corner[2] - corner[0];
        const float area = 0.5f * std::abs(u.x() * v.y() - u.y() * v.x());
        if (!(area > 1e-10f)) {
            throw Error("garment mesh: triangle " + std::to_string(t) +
                        " has no area in its material coordinates");
        }
        model.area += area;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            model.mass[vertex] += fabric.density * area / 3.0f;
            std::size_t from = k;
            std::size_t to = (k + 1) % 3;
            if (mesh.triangles[t][from] > mesh.triangles[t][to]) {
                std::swap(from, to);
            }
            const Vec2f along = corner[to] - corner[from];
            const float length = along.norm();
            const Vec2f unit = along / length;
            HalfEdge side{};
            side.a = mesh.triangles[t][from];
            side.b = mesh.triangles[t][to];
            side.opposite = mesh.triangles[t][(k + 2) % 3];
            side.length = length;
            side.height = 2.0f * area / length;
            side.foot = (corner[(k + 2) % 3] - corner[from]).dot(unit);
            side.area = area;
            side.stiffness = cloth::directional_stiffness(fabric, unit);
            side.rigidity = cloth::directional_rigidity(fabric, unit);
            sides.push_back(side);
        }
    }
    std::stable_sort(sides.begin(), sides.end(), [](const HalfEdge& l, const HalfEdge& r) {
        return l.a != r.a ? l.a < r.a : l.b < r.b;
    });
    return sides;
}

/// Distance spring that stores, at a fold of half a radian, what a hinge of the given rigidity
/// does: hinge energy 3/2 B l^2 / (A1 + A2) theta^2, spring shortening h1 h2 theta^2 / (2 d).
Spring bending_spring(const HalfEdge& p, const HalfEdge& q) {
    constexpr float kFold = 0.5f;
    const float length = 0.5f * (p.length + q.length);
    const float across = p.height + q.height;
    const float shift = p.foot - q.foot;
    const float rest = std::sqrt(across * across + shift * shift);
    const float hinge =
        3.0f * 0.5f * (p.rigidity + q.rigidity) * length * length / (p.area + q.area);
    const float shortening = p.height * q.height / (2.0f * rest);
    return {p.opposite, q.opposite, rest, hinge / (shortening * shortening * kFold * kFold)};
}

void add_springs(std::span<const HalfEdge> sides, ClothModel& model) {
    double length_sum = 0.0;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].a == sides[i].a && sides[end].b == sides[i].b) {
            ++end;
        }
        float stiffness = 0.0f;
        float rest = 0.0f;
        for (std::size_t k = i; k < end; ++k) {
            stiffness += sides[k].stiffness * sides[k].area / (sides[k].length * sides[k].length);
            rest += sides[k].length / static_cast<float>(end - i);
        }
        model.stretch.push_back({sides[i].a, sides[i].b, rest, stiffness});
        length_sum += rest;
        if (end - i >= 2 && sides[i].opposite != sides[i + 1].opposite) {
            model.bend.push_back(bending_spring(sides[i], sides[i + 1]));
        }
        i = end;
    }
    model.mean_edge = static_cast<float>(length_sum / static_cast<double>(model.stretch.size()));
}

} // namespace

ClothModel make_cloth_model(const ClothMesh& mesh, const Fabric& fabric, float limit_edges) {
    cloth::check(mesh, fabric);
    ClothModel model;
    model.mass.assign(mesh.positions.size(), 0.0f);
    const std::vector<HalfEdge> sides = half_edges(mesh, fabric, model);
    add_springs(sides, model);
    const auto used = static_cast<float>(
        std::count_if(model.mass.begin(), model.mass.end(), [](float m) { return m > 0.0f; }));
    const float mean_mass = fabric.density * static_cast<float>(model.area) / used;
    for (float& mass : model.mass) {
        mass = mass > 0.0f ? mass : mean_mass;
    }
    if (limit_edges > 0.0f) {
        std::vector<cloth::MaterialPath> paths;
        for (const std::vector<Spring>* springs : {&model.stretch, &model.bend}) {
            for (const Spring& spring : *springs) {
                paths.push_back({spring.a, spring.b, spring.rest});
            }
        }
        model.limits =
            cloth::make_length_limits(mesh.positions.size(), paths, limit_edges * model.mean_edge);
    }
    const float seam_stiffness = 0.5f * (fabric.stretch_warp + fabric.stretch_weft);
    for (const auto& seam : mesh.seams) {
        if (seam[0] != seam[1]) {
            model.stretch.push_back({seam[0], seam[1], 0.0f, seam_stiffness});
        }
    }
    return model;
}

} // namespace toile::bullet_cloth
