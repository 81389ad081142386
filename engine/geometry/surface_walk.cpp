#include "geometry/surface_walk.h"

#include "core/error.h"

#include <algorithm>
#include <string>

namespace toile::geometry {
namespace {

/// Where on a triangle the nearest point lies.
enum Feature : int { kFace = 0, kSide0 = 1, kSide1 = 2, kSide2 = 3, kCorner0 = 4 };

} // namespace

SurfaceWalk::SurfaceWalk(std::span<const Triangle> triangles, std::size_t vertex_count,
                         std::span<const std::uint8_t> groups)
    : triangles_(triangles.begin(), triangles.end()), groups_(groups.begin(), groups.end()) {
    for (const Triangle& corner : triangles_) {
        if (*std::max_element(corner.begin(), corner.end()) >= vertex_count) {
            throw Error("surface walk: a triangle names a vertex out of range");
        }
    }
    if (groups_.empty()) {
        groups_.assign(triangles_.size(), 0);
    }
    if (groups_.size() != triangles_.size()) {
        throw Error("surface walk: " + std::to_string(groups_.size()) + " groups for " +
                    std::to_string(triangles_.size()) + " triangles");
    }
    star_first_.assign(vertex_count + 1, 0);
    for (const Triangle& corner : triangles_) {
        for (const std::uint32_t v : corner) {
            ++star_first_[v + 1];
        }
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
        star_first_[v + 1] += star_first_[v];
    }
    star_.resize(3 * triangles_.size());
    ring_.resize(3 * triangles_.size());
    std::vector<std::uint32_t> next(star_first_.begin(), star_first_.end() - 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = triangles_[t][k];
            ring_[next[v]] = triangles_[t][(k + 1) % 3];
            star_[next[v]++] = static_cast<std::uint32_t>(t);
        }
    }
    across_.assign(3 * triangles_.size(), kNoTriangle);
    border_.assign(vertex_count, 0);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles_[t][k];
            const std::uint32_t b = triangles_[t][(k + 1) % 3];
            for (std::uint32_t s = star_first_[a]; s < star_first_[a + 1]; ++s) {
                const Triangle& other = triangles_[star_[s]];
                if (star_[s] != t && std::find(other.begin(), other.end(), b) != other.end()) {
                    across_[3 * t + k] = star_[s];
                }
            }
            if (across_[3 * t + k] == kNoTriangle) {
                border_[a] = border_[b] = 1;
            }
        }
    }
}

/// Nearest point of one triangle; replaces `best` when nearer. (Ericson 2005, 5.1.5)
void SurfaceWalk::closest_on(std::span<const Vec4f> positions, const Vec4f& p,
                             std::uint32_t triangle, WalkPoint& best, int& feature) const noexcept {
    const Triangle& corner = triangles_[triangle];
    const Vec4f a = positions[corner[0]];
    const Vec4f ab = positions[corner[1]] - a;
    const Vec4f ac = positions[corner[2]] - a;
    const Vec4f ap = p - a;
    const float d1 = ab.dot(ap);
    const float d2 = ac.dot(ap);
    const float ab2 = ab.dot(ab);
    const float ac2 = ac.dot(ac);
    const float abac = ab.dot(ac);
    const float d3 = d1 - ab2; // ab . bp
    const float d4 = d2 - abac;
    const float d5 = d1 - abac; // ab . cp
    const float d6 = d2 - ac2;
    const float va = d3 * d6 - d5 * d4;
    const float vb = d5 * d2 - d1 * d6;
    const float vc = d1 * d4 - d3 * d2;
    float v = 0.0f;
    float w = 0.0f;
    int where = kFace;
    if (d1 <= 0.0f && d2 <= 0.0f) {
        where = kCorner0;
    } else if (d3 >= 0.0f && d4 <= d3) {
        where = kCorner0 + 1;
        v = 1.0f;
    } else if (d6 >= 0.0f && d5 <= d6) {
        where = kCorner0 + 2;
        w = 1.0f;
    } else if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
        where = kSide0;
        v = d1 / (d1 - d3);
    } else if (va <= 0.0f && d4 >= d3 && d5 >= d6) {
        where = kSide1;
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1.0f - w;
    } else if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
        where = kSide2;
        w = d2 / (d2 - d6);
    } else {
        const float inverse = 1.0f / (va + vb + vc);
        v = vb * inverse;
        w = vc * inverse;
    }
    const Vec4f point = a + v * ab + w * ac;
    const float squared = (p - point).squaredNorm();
    if (squared < best.squared) {
        best.triangle = triangle;
        best.squared = squared;
        best.bary[0] = 1.0f - v - w;
        best.bary[1] = v;
        best.bary[2] = w;
        best.point = point;
        feature = where;
    }
}

WalkPoint SurfaceWalk::walk(std::span<const Vec4f> positions, const Vec4f& p, std::uint32_t start,
                            GroupMask allowed) const noexcept {
    constexpr int kMostSteps = 48;
    WalkPoint best;
    int feature = kFace;
    closest_on(positions, p, start, best, feature);
    const auto open = [&](std::uint32_t t) { return ((allowed >> groups_[t]) & 1u) != 0; };
    const auto leads = [&](std::uint32_t t, const Vec4f& at, const Vec4f& towards) {
        const Triangle& corner = triangles_[t];
        return (positions[corner[0]] - at).dot(towards) > 0.0f ||
               (positions[corner[1]] - at).dot(towards) > 0.0f ||
               (positions[corner[2]] - at).dot(towards) > 0.0f;
    };
    for (int step = 0; step < kMostSteps && feature != kFace && best.triangle != kNoTriangle;
         ++step) {
        const std::uint32_t from = best.triangle;
        // A neighbour is nearer only if it leads from the nearest point towards p.
        const Vec4f at = best.point;
        const Vec4f towards = p - at;
        if (feature < kCorner0) {
            const std::uint32_t next = across(from, static_cast<std::size_t>(feature - kSide0));
            if (next != kNoTriangle && open(next) && leads(next, at, towards)) {
                closest_on(positions, p, next, best, feature);
            }
        } else {
            const std::uint32_t v = triangles_[from][static_cast<std::size_t>(feature - kCorner0)];
            // Convex there: no edge leads closer, so no triangle does.
            bool closer = border_[v] != 0;
            for (std::uint32_t s = star_first_[v]; s < star_first_[v + 1]; ++s) {
                closer = closer || (positions[ring_[s]] - at).dot(towards) > 0.0f;
            }
            if (!closer) {
                break;
            }
            for (std::uint32_t s = star_first_[v]; s < star_first_[v + 1]; ++s) {
                if (star_[s] != from && open(star_[s]) && leads(star_[s], at, towards)) {
                    closest_on(positions, p, star_[s], best, feature);
                }
            }
        }
        if (best.triangle == from) {
            break;
        }
    }
    return best;
}

} // namespace toile::geometry
