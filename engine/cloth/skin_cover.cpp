#include "cloth/skin_cover.h"

#include <algorithm>

namespace toile::cloth {
namespace {

constexpr float kLift = 0.001f;    ///< m, of the cloth over the skin
constexpr float kDeepest = -0.03f; ///< m, beyond it is another part

/// Where the line from a body vertex along its normal meets a garment triangle.
struct Crossing {
    float height; ///< m, of the cloth over the vertex
    std::array<float, 3> share;
    bool inside; ///< of the triangle, and facing out
};

inline Crossing cross(const Vec4& from, const Vec4& up, const Triangle& corner,
                      std::span<const Vec4> x) {
    const Vec4 ab = x[corner[1]] - x[corner[0]];
    const Vec4 ac = x[corner[2]] - x[corner[0]];
    const Vec4 area = ab.cross3(ac);
    const float facing = area.dot(up);
    if (facing <= 1e-12f) {
        return {0.0f, {}, false};
    }
    const Vec4 rise = x[corner[0]] - from;
    const Vec4 across = up.cross3(rise);
    const float v = -across.dot(ac) / facing;
    const float w = across.dot(ab) / facing;
    const float u = 1.0f - v - w;
    return {rise.dot(area) / facing, {u, v, w}, u >= 0.0f && v >= 0.0f && w >= 0.0f};
}

using Skin = std::array<std::uint32_t, SkinCover::kMostSkin>;

/// After the corners of a body triangle those across its sides. \return how many there are then
std::size_t add_across(const MovingBody& body, std::uint32_t under, Skin& skin) {
    std::size_t count = 3;
    for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t next = body.across(under, side);
        if (next == kNone) {
            continue;
        }
        const Triangle& beside = body.triangles()[next];
        const auto fresh = std::find_if(beside.begin(), beside.end(), [&](std::uint32_t b) {
            return std::find(skin.begin(), skin.begin() + 3, b) == skin.begin() + 3;
        });
        if (fresh != beside.end()) {
            skin[count++] = *fresh;
        }
    }
    return count;
}

/// After the corners of the body triangle under one vertex those under the other two.
std::size_t add_corners(const MovingBody& body, const BodyContacts& contacts,
                        const Triangle& corner, Skin& skin) {
    std::size_t count = 3;
    for (std::size_t k = 1; k < 3; ++k) {
        const std::uint32_t under = contacts.own_triangle(corner[k]);
        if (under == kNone || under == contacts.own_triangle(corner[0])) {
            continue;
        }
        for (const std::uint32_t b : body.triangles()[under]) {
            const auto end = skin.begin() + std::ptrdiff_t(count);
            if (std::find(skin.begin(), end, b) == end) {
                skin[count++] = b;
            }
        }
    }
    return count;
}

bool is_squeezed(const BodyContacts& contacts, const Triangle& corner) {
    return contacts.is_squeezed(corner[0]) || contacts.is_squeezed(corner[1]) ||
           contacts.is_squeezed(corner[2]);
}

} // namespace

void SkinCover::find(const MovingBody& body, const BodyContacts& contacts, std::span<const Vec4> x,
                     float close) noexcept {
    pairs_.clear();
    const std::span<const Triangle> triangles = contacts.triangles();
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const Triangle& corner = triangles[t];
        const std::uint32_t under =
            contacts.own_triangle(contacts.has_centres() ? x.size() + t : corner[0]);
        if (under == kNone || is_squeezed(contacts, corner)) {
            continue; // the skin under it lies within another part
        }
        const Triangle& below = body.triangles()[under];
        const Vec4 centre = (x[corner[0]] + x[corner[1]] + x[corner[2]]) / 3.0f;
        const float above = (centre - body.positions()[below[0]]).dot(body.normals()[below[0]]);
        if (above > 2.0f * close) {
            continue;
        }
        float radius2 = 0.0f;
        for (const std::uint32_t v : corner) {
            radius2 = std::max(radius2, (x[v] - centre).squaredNorm());
        }
        std::array<std::uint32_t, kMostSkin> skin{below[0], below[1], below[2]};
        const std::size_t count = contacts.has_centres()
                                      ? add_across(body, under, skin)
                                      : add_corners(body, contacts, corner, skin);
        for (std::size_t k = 0; k < count; ++k) {
            // Its line along its normal meets nothing where it passes all corners by.
            const Vec4 rise = centre - body.positions()[skin[k]];
            const float along = rise.dot(body.normals()[skin[k]]);
            if (rise.squaredNorm() - along * along > 1.01f * radius2) {
                continue;
            }
            const Crossing found =
                cross(body.positions()[skin[k]], body.normals()[skin[k]], corner, x);
            if (found.inside && found.height < close && found.height > kDeepest) {
                pairs_.push_back({t, skin[k]});
            }
        }
    }
}

void SkinCover::lift(const MovingBody& body, std::span<const Triangle> triangles, std::span<Vec4> x,
                     std::span<const float> inverse_mass) const noexcept {
    constexpr float kLeastWeight = 0.05f; // where the corners that may move hold too little
    for (const Pair& pair : pairs_) {
        const Triangle& corner = triangles[pair.triangle];
        const Vec4 up = body.normals()[pair.skin];
        const Crossing found = cross(body.positions()[pair.skin], up, corner, x);
        if (!found.inside || found.height >= kLift || found.height < kDeepest) {
            continue;
        }
        float weight = 0.0f;
        for (std::size_t k = 0; k < 3; ++k) {
            weight += inverse_mass[corner[k]] > 0.0f ? found.share[k] * found.share[k] : 0.0f;
        }
        if (weight < kLeastWeight) {
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            if (inverse_mass[corner[k]] > 0.0f) {
                x[corner[k]] += ((kLift - found.height) * found.share[k] / weight) * up;
            }
        }
    }
}

} // namespace toile::cloth
