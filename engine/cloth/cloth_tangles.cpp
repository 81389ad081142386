// The part of cloth_contacts.h that takes tangles apart: where an edge passes through a triangle,
// nobody can tell who belongs on which side, but the contour along which two sheets cut each other
// can be made shorter until it is gone (Volino and Magnenat-Thalmann 2006).
#include "cloth/cloth_contacts.h"

#include <algorithm>
#include <cmath>

namespace toile::cloth {
namespace {

/// Where an edge passes through a triangle.
struct Passage {
    float along; ///< the edge, 0..1
    float share[3];
    Vec4f normal; ///< of the triangle, unit
};

bool passes(const Vec4f& a, const Vec4f& b, const Vec4f& p, const Vec4f& q, const Vec4f& r,
            Passage& out) {
    const Vec4f pq = q - p;
    const Vec4f pr = r - p;
    const Vec4f area = pq.cross3(pr);
    const float height_a = (a - p).dot(area);
    const float height_b = (b - p).dot(area);
    if (height_a * height_b >= 0.0f) {
        return false;
    }
    out.along = height_a / (height_a - height_b);
    const Vec4f at = a + out.along * (b - a) - p;
    const float squared = area.squaredNorm();
    out.share[1] = at.cross3(pr).dot(area) / squared;
    out.share[2] = pq.cross3(at).dot(area) / squared;
    out.share[0] = 1.0f - out.share[1] - out.share[2];
    out.normal = area / std::sqrt(squared);
    return std::min({out.share[0], out.share[1], out.share[2]}) >= 0.0f;
}

} // namespace

/// The way in which the edge a-b shortens the contour on its own two triangles fastest.
Vec4f ClothContacts::way_out(std::span<const Vec4f> x, std::uint32_t a, std::uint32_t b,
                             const Vec4f& normal) const noexcept {
    constexpr float kFlat = 0.1f; // an edge in the triangle's plane says little
    const Vec4f edge = (x[b] - x[a]).normalized();
    const float steep = edge.dot(normal);
    const float across = std::copysign(std::max(std::abs(steep), kFlat), steep);
    Vec4f way = Vec4f::Zero();
    for (std::uint32_t s = star_first_[a]; s < star_first_[a + 1]; ++s) {
        const Triangle& t = triangles_[star_[s]];
        if (std::find(t.begin(), t.end(), b) == t.end()) {
            continue;
        }
        const std::uint32_t c = t[0] ^ t[1] ^ t[2] ^ a ^ b; // its third corner
        Vec4f contour = normal.cross3(edge.cross3(x[c] - x[a]));
        const float length = contour.norm();
        if (length < 1e-12f) {
            continue;
        }
        const Vec4f inwards = x[c] - x[a] - edge.dot(x[c] - x[a]) * edge;
        contour *= (contour.dot(inwards) < 0.0f ? -1.0f : 1.0f) / length;
        way += contour - (2.0f * edge.dot(contour) / across) * normal;
    }
    return way / std::sqrt(way.squaredNorm() + 0.25f);
}

void ClothContacts::part(std::span<Vec4f> x, std::uint32_t a, std::uint32_t b,
                         const Triangle& t) noexcept {
    constexpr float kStep = 0.003f; // m, in a frame
    Passage at{};
    if (!passes(x[a], x[b], x[t[0]], x[t[1]], x[t[2]], at)) {
        return;
    }
    const std::uint32_t rows[5] = {a, b, t[0], t[1], t[2]};
    const float share[5] = {1.0f - at.along, at.along, -at.share[0], -at.share[1], -at.share[2]};
    float weight = 0.0f;
    for (std::size_t k = 0; k < 5; ++k) {
        weight += share[k] * share[k] * vertices_[rows[k]].weight;
        tangled_[rows[k]] = 1;
    }
    if (weight <= 0.0f) {
        return;
    }
    const Vec4f shift = (kStep / weight) * way_out(x, a, b, at.normal);
    for (std::size_t k = 0; k < 5; ++k) {
        x[rows[k]] += (share[k] * vertices_[rows[k]].weight) * shift;
    }
}

void ClothContacts::part_tangles(std::span<Vec4f> x) noexcept {
    std::fill(tangled_.begin(), tangled_.end(), std::uint8_t{0});
    const std::size_t rows = vertices_.size();
    for (std::size_t slot = 0; slot < 2 * rows; ++slot) {
        const std::uint32_t near = nearest_[slot];
        const auto a = static_cast<std::uint32_t>(slot % rows);
        if (near == kNobody || layered(x, a, near)) {
            continue; // which of two layers is outside is known
        }
        for (std::uint32_t s = star_first_[a]; s < star_first_[a + 1]; ++s) {
            const Triangle& mine = triangles_[star_[s]];
            const std::size_t k = mine[0] == a ? 0 : mine[1] == a ? 1 : 2;
            const std::uint32_t b = mine[(k + 1) % 3];
            if (b < a && nearest_[slot - a + b] == near) {
                continue; // seen from its other end
            }
            for (std::uint32_t other = star_first_[near]; other < star_first_[near + 1]; ++other) {
                part(x, a, b, triangles_[star_[other]]);
            }
        }
    }
    for (std::size_t slot = 0; slot < 2 * rows; ++slot) {
        met_[slot] = tangled_[slot % rows] != 0 ? kNobody : met_[slot];
    }
}

} // namespace toile::cloth
