#include "xpbd_cloth/bending.h"

#include "xpbd_cloth/colouring.h"

#include <algorithm>
#include <cmath>

namespace toile::xpbd_cloth {
namespace {

/// A triangle's side as seen from that triangle, in its material.
struct Side {
    std::uint32_t a, b, opposite; ///< a < b
    float length;                 ///< m
    float cot_a, cot_b;           ///< of the angles at a and b
    float area;                   ///< m^2
    float rigidity;               ///< N m
};

std::vector<Side> sorted_sides(const ClothMesh& mesh, const Fabric& fabric) {
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<Vec2f, 3> corner = cloth::material_corners(mesh, t);
        const Vec2f u = corner[1] - corner[0];
        const Vec2f v = corner[2] - corner[0];
        const float twice = std::max(std::abs(u.x() * v.y() - u.y() * v.x()), 1e-12f);
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t from = k;
            std::size_t to = (k + 1) % 3;
            const std::size_t top = (k + 2) % 3;
            if (mesh.triangles[t][from] > mesh.triangles[t][to]) {
                std::swap(from, to);
            }
            const Vec2f along = corner[to] - corner[from];
            const Vec2f up = corner[top] - corner[from];
            const float length = along.norm();
            sides.push_back({mesh.triangles[t][from], mesh.triangles[t][to], mesh.triangles[t][top],
                             length, up.dot(along) / twice, (along - up).dot(along) / twice,
                             0.5f * twice, cloth::directional_rigidity(fabric, along / length)});
        }
    }
    std::stable_sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
        return l.a != r.a ? l.a < r.a : l.b < r.b;
    });
    return sides;
}

bool same_edge(const Side& l, const Side& r) {
    return l.a == r.a && l.b == r.b;
}

} // namespace

std::vector<Edge> material_edges(const ClothMesh& mesh) {
    const std::vector<Side> sides = sorted_sides(mesh, Fabric{});
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i;
        float length = 0.0f;
        while (end < sides.size() && same_edge(sides[end], sides[i])) {
            length += sides[end++].length;
        }
        edges.push_back(
            {sides[i].a, sides[i].b, length / static_cast<float>(end - i), end - i == 1});
        i = end;
    }
    return edges;
}

std::vector<cloth::MaterialPath> material_paths(const ClothMesh& mesh) {
    std::vector<cloth::MaterialPath> paths;
    for (const Edge& edge : material_edges(mesh)) {
        paths.push_back({edge.a, edge.b, edge.rest});
    }
    const std::vector<Side> sides = sorted_sides(mesh, Fabric{});
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side& p = sides[i];
        const Side& q = sides[i + 1];
        if (same_edge(p, q) && p.opposite != q.opposite) {
            const float across = 2.0f * (p.area + q.area) / p.length;
            const float along =
                2.0f * (p.cot_a * p.area - q.cot_a * q.area) / p.length; // between the feet
            paths.push_back({p.opposite, q.opposite, std::hypot(across, along)});
        }
    }
    return paths;
}

Bending::Bending(const ClothMesh& mesh, const Fabric& fabric, std::span<const float> inverse_mass) {
    const std::vector<Side> sides = sorted_sides(mesh, fabric);
    std::vector<Hinge<std::uint32_t>> hinges;
    std::vector<Softness> softness;
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side& p = sides[i];
        const Side& q = sides[i + 1];
        const bool first = i == 0 || !same_edge(sides[i - 1], p);
        const float rigidity = 0.5f * (p.rigidity + q.rigidity);
        if (!first || !same_edge(p, q) || p.opposite == q.opposite || !(rigidity > 0.0f)) {
            continue;
        }
        const Hinge<std::uint32_t> hinge{
            {p.a, p.b, p.opposite, q.opposite},
            {p.cot_a + q.cot_a, -p.cot_a - p.cot_b, -q.cot_a - q.cot_b},
            0.0f};
        const float k0 = -(hinge.k[0] + hinge.k[1] + hinge.k[2]);
        Softness soft{inverse_mass[p.a] * k0 * k0, (p.area + q.area) / rigidity};
        for (std::size_t k = 1; k < 4; ++k) {
            soft.sum += inverse_mass[hinge.vertex[k]] * hinge.k[k - 1] * hinge.k[k - 1];
        }
        hinges.push_back(hinge);
        softness.push_back(soft);
        corners.insert(corners.end(), std::begin(hinge.vertex), std::end(hinge.vertex));
    }
    // One after another shares no vertex, so that the processor need not wait.
    for (const std::uint32_t c : coloured_order(corners, 4, inverse_mass.size(), 1)) {
        const Hinge<std::uint32_t>& h = hinges[c];
        softness_.push_back(softness[c]);
        if (inverse_mass.size() >= kSmallRows) {
            large_.push_back(h);
            continue;
        }
        small_.push_back({{SmallIndex(h.vertex[0]), SmallIndex(h.vertex[1]),
                           SmallIndex(h.vertex[2]), SmallIndex(h.vertex[3])},
                          {h.k[0], h.k[1], h.k[2]},
                          0.0f});
    }
}

void Bending::set_substep(float seconds) noexcept {
    if (seconds == substep_) {
        return;
    }
    substep_ = seconds;
    for (std::size_t i = 0; i < softness_.size(); ++i) {
        const float step =
            1.0f / (softness_[i].sum + softness_[i].compliance / (seconds * seconds));
        (large_.empty() ? small_[i].step : large_[i].step) = step;
    }
}

template <class Index>
[[gnu::always_inline]] inline void Bending::solve_hinge(const Hinge<Index>& hinge,
                                                        Vec4f* x) noexcept {
    __m128 p[4];
    for (std::size_t i = 0; i < 4; ++i) {
        p[i] = _mm_load_ps(x[hinge.vertex[i]].data());
    }
    const __m128 k1 = _mm_set1_ps(hinge.k[0]);
    const __m128 k2 = _mm_set1_ps(hinge.k[1]);
    const __m128 k3 = _mm_set1_ps(hinge.k[2]);
    const __m128 k[4] = {_mm_sub_ps(_mm_setzero_ps(), _mm_add_ps(_mm_add_ps(k1, k2), k3)), k1, k2,
                         k3};
    __m128 c = _mm_mul_ps(k[0], p[0]);
    for (std::size_t i = 1; i < 4; ++i) {
        c = _mm_fmadd_ps(k[i], p[i], c);
    }
    c = _mm_blend_ps(_mm_mul_ps(_mm_set1_ps(hinge.step), c), _mm_setzero_ps(), 8); // masses stay
    for (std::size_t i = 0; i < 4; ++i) {
        const __m128 weight = _mm_permute_ps(p[i], 0xff);
        _mm_store_ps(x[hinge.vertex[i]].data(), _mm_fnmadd_ps(_mm_mul_ps(weight, k[i]), c, p[i]));
    }
}

void Bending::solve(std::span<Vec4f> x) const noexcept {
    for (const Hinge<SmallIndex>& hinge : small_) {
        cloth::read_ahead(hinge);
        solve_hinge(hinge, x.data());
    }
    for (const Hinge<std::uint32_t>& hinge : large_) {
        cloth::read_ahead(hinge);
        solve_hinge(hinge, x.data());
    }
}

} // namespace toile::xpbd_cloth
