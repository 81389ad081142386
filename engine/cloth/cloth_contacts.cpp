#include "cloth/cloth_contacts.h"

#include <algorithm>
#include <cmath>

namespace toile::cloth {
namespace {

/// Barycentric place of p over a triangle, moved onto it where it is beside.
std::array<float, 3> place_over(const Vec4f& p, const Vec4f& a, const Vec4f& b, const Vec4f& c) {
    const Vec4f ab = b - a;
    const Vec4f ac = c - a;
    const Vec4f ap = p - a;
    const float bb = ab.dot(ab);
    const float bc = ab.dot(ac);
    const float cc = ac.dot(ac);
    const float det = std::max(bb * cc - bc * bc, 1e-20f);
    float v = (cc * ab.dot(ap) - bc * ac.dot(ap)) / det;
    float w = (bb * ac.dot(ap) - bc * ab.dot(ap)) / det;
    v = std::clamp(v, 0.0f, 1.0f);
    w = std::clamp(w, 0.0f, 1.0f);
    const float sum = std::max(1.0f, v + w);
    return {1.0f - (v + w) / sum, v / sum, w / sum};
}

} // namespace

void ClothContacts::arrange(std::span<const ClothPart> parts, std::size_t rows) {
    constexpr float kSamePiece = 4.0f; // edges
    constexpr float kSameFold = 0.04f; // m, nearer along the cloth is a fold: bending's matter
    parts_.assign(parts.begin(), parts.end());
    vertices_.assign(rows, {});
    triangles_.clear();
    float longest_edge = 0.0f;
    for (std::uint32_t k = 0; k < parts.size(); ++k) {
        const ClothPart& part = parts[k];
        longest_edge = std::max(longest_edge, part.mean_edge);
        for (std::size_t v = 0; v < part.start.size(); ++v) {
            vertices_[part.first + v] = {part.start[v], part.inverse_mass[v],
                                         std::max(kSamePiece * part.mean_edge, kSameFold), k};
        }
        const auto base = static_cast<std::uint32_t>(part.first);
        for (const Triangle& t : part.triangles) {
            triangles_.push_back({t[0] + base, t[1] + base, t[2] + base});
        }
    }
    reach_ = std::clamp(0.6f * longest_edge, 0.004f, 0.01f);
    radius_ = 0.8f * longest_edge + reach_;
    star_first_.assign(rows + 1, 0);
    for (const Triangle& t : triangles_) {
        for (const std::uint32_t v : t) {
            ++star_first_[v + 1];
        }
    }
    for (std::size_t v = 0; v < rows; ++v) {
        star_first_[v + 1] += star_first_[v];
    }
    star_.resize(3 * triangles_.size());
    std::vector<std::uint32_t> next(star_first_.begin(), star_first_.end() - 1);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        for (const std::uint32_t v : triangles_[t]) {
            star_[next[v]++] = t;
        }
    }
    nearest_.assign(rows, kNobody);
    std::vector<ClothTree::Vertex> leaves(rows);
    for (std::size_t v = 0; v < rows; ++v) {
        const Vec3f& p = vertices_[v].start;
        leaves[v] = {Vec4f(p.x(), p.y(), p.z(), 0.0f), vertices_[v].apart, vertices_[v].part};
    }
    tree_.arrange(leaves);
    met_.assign(rows, kNobody);
    side_.assign(rows, 0.0f);
    contacts_.clear();
    contacts_.reserve(rows);
}

void ClothContacts::reset() noexcept {
    std::fill(met_.begin(), met_.end(), kNobody);
    std::fill(side_.begin(), side_.end(), 0.0f);
    contacts_.clear();
}

/// Is one triangle a near neighbour of the other in the cloth, and not folded back over it? Only
/// then is what lies over the one over the other too.
bool ClothContacts::same_sheet(std::span<const Vec4f> x, std::uint32_t first,
                               std::uint32_t second) const noexcept {
    const Triangle& s = triangles_[first];
    const Triangle& t = triangles_[second];
    const Vertex& a = vertices_[s[0]];
    const Vertex& b = vertices_[t[0]];
    const float near = 0.5f * a.apart;
    const Vec4f normal_s = (x[s[1]] - x[s[0]]).cross3(x[s[2]] - x[s[0]]);
    const Vec4f normal_t = (x[t[1]] - x[t[0]]).cross3(x[t[2]] - x[t[0]]);
    return a.part == b.part && (a.start - b.start).squaredNorm() < near * near &&
           normal_s.dot(normal_t) > 0.0f;
}

/// Lists the contact of a vertex with the nearest triangle at another one.
void ClothContacts::meet(std::span<const Vec4f> x, std::uint32_t vertex, std::uint32_t other,
                         float reach) noexcept {
    const Vec4f& p = x[vertex];
    float least = reach * reach;
    std::uint32_t nearest = kNobody;
    std::array<float, 3> place{};
    for (std::uint32_t s = star_first_[other]; s < star_first_[other + 1]; ++s) {
        const Triangle& t = triangles_[star_[s]];
        const std::array<float, 3> over = place_over(p, x[t[0]], x[t[1]], x[t[2]]);
        const Vec4f at = over[0] * x[t[0]] + over[1] * x[t[1]] + over[2] * x[t[2]];
        const float squared = (p - at).squaredNorm();
        if (squared < least) {
            least = squared;
            nearest = star_[s];
            place = over;
        }
    }
    if (nearest == kNobody) {
        met_[vertex] = kNobody;
        return;
    }
    const Triangle& t = triangles_[nearest];
    const ClothPart& mine = parts_[vertices_[vertex].part];
    const ClothPart& theirs = parts_[vertices_[t[0]].part];
    const Vec4f normal = (x[t[1]] - x[t[0]]).cross3(x[t[2]] - x[t[0]]);
    const float height = (p - x[t[0]]).dot(normal) / std::max(normal.norm(), 1e-12f);
    constexpr float kSlant = 0.5f;
    if (std::abs(height) < kSlant * std::sqrt(least) && met_[vertex] == kNobody) {
        return; // beside the end of a sheet: on neither side of it
    }
    if (mine.layer != theirs.layer) {
        side_[vertex] = mine.layer > theirs.layer ? 1.0f : -1.0f;
    } else if (met_[vertex] == kNobody || !same_sheet(x, met_[vertex], nearest)) {
        side_[vertex] = height >= 0.0f ? 1.0f : -1.0f;
    }
    met_[vertex] = nearest;
    constexpr float kAir = 0.001f; // m, beyond half of both thicknesses
    const float gap = 0.5f * (mine.thickness + theirs.thickness) + kAir;
    contacts_.push_back({vertex,
                         {t[0], t[1], t[2]},
                         {place[0], place[1], place[2]},
                         side_[vertex],
                         std::min(gap, reach_),
                         std::max(mine.friction, theirs.friction)});
}

/// Where most of the neighbours that touch the same piece do so on its other side, go there.
void ClothContacts::untangle() noexcept {
    for (Contact& contact : contacts_) {
        const Vertex& there = vertices_[contact.corner[0]];
        int same = 0;
        int opposite = 0;
        for (std::uint32_t s = star_first_[contact.vertex]; s < star_first_[contact.vertex + 1];
             ++s) {
            for (const std::uint32_t v : triangles_[star_[s]]) {
                if (v != contact.vertex && met_[v] != kNobody &&
                    same_piece(vertices_[triangles_[met_[v]][0]], there)) {
                    ++(side_[v] == contact.side ? same : opposite);
                }
            }
        }
        constexpr int kFew = 3; // a neighbour counts in each of two triangles
        contact.side = opposite > 2 * same + kFew ? -contact.side : contact.side;
    }
    for (const Contact& contact : contacts_) {
        side_[contact.vertex] = contact.side;
    }
}

void ClothContacts::find(std::span<const Vec4f> x, std::span<const Vec4f> v,
                         float seconds) noexcept {
    contacts_.clear();
    tree_.find(x, radius_, nearest_);
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
        if (nearest_[i] == kNobody) {
            met_[i] = kNobody;
        } else if (vertices_[i].weight > 0.0f) {
            meet(x, i, nearest_[i], std::min(reach_ + v[i].norm() * seconds, radius_));
        }
    }
    untangle();
}

void ClothContacts::resolve(std::span<Vec4f> x, std::span<Vec4f> q) const noexcept {
    for (const Contact& c : contacts_) {
        Vec4f* const corner[3] = {&x[c.corner[0]], &x[c.corner[1]], &x[c.corner[2]]};
        Vec4f normal = (*corner[1] - *corner[0]).cross3(*corner[2] - *corner[0]);
        const float area = normal.norm();
        if (area < 1e-12f) {
            continue;
        }
        normal *= c.side / area;
        const Vec4f apart = x[c.vertex] - c.share[0] * *corner[0] - c.share[1] * *corner[1] -
                            c.share[2] * *corner[2];
        const float push = c.gap - apart.dot(normal);
        float weight = vertices_[c.vertex].weight;
        for (std::size_t k = 0; k < 3; ++k) {
            weight += c.share[k] * c.share[k] * vertices_[c.corner[k]].weight;
        }
        if (push <= 0.0f || push > c.gap + reach_ || weight <= 0.0f) {
            continue;
        }
        // Friction takes from the sliding of one over the other in this substep.
        Vec4f slide = apart - q[c.vertex];
        for (std::size_t k = 0; k < 3; ++k) {
            slide += c.share[k] * q[c.corner[k]];
        }
        const float parting = slide.dot(normal) + push;
        slide -= slide.dot(normal) * normal;
        const float length = slide.norm();
        const float stick = length > 0.0f ? std::min(1.0f, c.friction * push / length) : 0.0f;
        const Vec4f shift = (push * normal - stick * slide) / weight;
        const Vec4f still = (std::clamp(parting, 0.0f, push) / weight) * normal;
        x[c.vertex] += vertices_[c.vertex].weight * shift;
        q[c.vertex] += vertices_[c.vertex].weight * still;
        for (std::size_t k = 0; k < 3; ++k) {
            q[c.corner[k]] -= (c.share[k] * vertices_[c.corner[k]].weight) * still;
            *corner[k] -= (c.share[k] * vertices_[c.corner[k]].weight) * shift;
        }
    }
}

} // namespace toile::cloth
