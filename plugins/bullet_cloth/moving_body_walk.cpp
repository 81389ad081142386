// The walk over the body's triangles to the nearest point.
#include "bullet_cloth/moving_body.h"

namespace toile::bullet_cloth {
namespace {

/// Where on a triangle the nearest point lies.
enum Feature : int { kFace = 0, kSide0 = 1, kSide1 = 2, kSide2 = 3, kCorner0 = 4 };

} // namespace

/// Nearest point of one triangle; replaces `best` when nearer. (Ericson 2005, 5.1.5)
void MovingBody::closest_on(const Vec4& p, std::uint32_t triangle, SurfacePoint& best,
                            int& feature) const noexcept {
    const Triangle& corner = triangles_[triangle];
    const Vec4 a = now_[corner[0]];
    const Vec4 ab = now_[corner[1]] - a;
    const Vec4 ac = now_[corner[2]] - a;
    const Vec4 ap = p - a;
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
    const Vec4 point = a + v * ab + w * ac;
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

SurfacePoint MovingBody::walk(const Vec4& p, std::uint32_t start,
                              JointMask allowed) const noexcept {
    constexpr int kMostSteps = 48;
    SurfacePoint best;
    int feature = kFace;
    closest_on(p, start, best, feature);
    const auto open = [&](std::uint32_t t) { return ((allowed >> triangle_joint_[t]) & 1u) != 0; };
    const auto leads = [&](std::uint32_t t, const Vec4& at, const Vec4& towards) {
        const Triangle& corner = triangles_[t];
        return (now_[corner[0]] - at).dot(towards) > 0.0f ||
               (now_[corner[1]] - at).dot(towards) > 0.0f ||
               (now_[corner[2]] - at).dot(towards) > 0.0f;
    };
    for (int step = 0; step < kMostSteps && feature != kFace && best.triangle != kNone; ++step) {
        const std::uint32_t from = best.triangle;
        // A neighbour is nearer only if it leads from the nearest point towards p.
        const Vec4 at = best.point;
        const Vec4 towards = p - at;
        if (feature < kCorner0) {
            const std::uint32_t next = across(from, static_cast<std::size_t>(feature - kSide0));
            if (next != kNone && open(next) && leads(next, at, towards)) {
                closest_on(p, next, best, feature);
            }
        } else {
            const std::uint32_t v = triangles_[from][static_cast<std::size_t>(feature - kCorner0)];
            // Convex there: no edge leads closer, so no triangle does.
            bool closer = false;
            for (std::uint32_t s = star_first_[v]; s < star_first_[v + 1]; ++s) {
                closer = closer || (now_[ring_[s]] - at).dot(towards) > 0.0f;
            }
            if (!closer) {
                break;
            }
            for (std::uint32_t s = star_first_[v]; s < star_first_[v + 1]; ++s) {
                if (star_[s] != from && open(star_[s]) && leads(star_[s], at, towards)) {
                    closest_on(p, star_[s], best, feature);
                }
            }
        }
        if (best.triangle == from) {
            break;
        }
    }
    return best;
}

} // namespace toile::bullet_cloth
