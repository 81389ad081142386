#include "geometry/closest_point.h"

#include <algorithm>

namespace toile::geometry {
namespace {

ClosestPoint on_side(const Vec3f& from, const Vec3f& to, float t, int first, int second,
                     Feature feature) noexcept {
    ClosestPoint result{from + t * (to - from), Vec3f::Zero(), feature};
    result.barycentric[first] = 1.0f - t;
    result.barycentric[second] = t;
    return result;
}

// For triangles without area: the nearest of the three sides.
ClosestPoint nearest_side(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) noexcept {
    const Vec3f* corners[3] = {&a, &b, &c};
    constexpr Feature kSides[3] = {Feature::side01, Feature::side12, Feature::side20};
    constexpr Feature kCorners[3] = {Feature::corner0, Feature::corner1, Feature::corner2};
    ClosestPoint best{a, Vec3f::UnitX(), Feature::corner0};
    float best_squared = (a - p).squaredNorm();
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const Vec3f side = *corners[next] - *corners[k];
        const float squared = side.squaredNorm();
        const float t =
            squared > 0.0f ? std::clamp((p - *corners[k]).dot(side) / squared, 0.0f, 1.0f) : 0.0f;
        ClosestPoint candidate = on_side(*corners[k], *corners[next], t, k, next, kSides[k]);
        if (t == 0.0f) candidate.feature = kCorners[k];
        if (t == 1.0f) candidate.feature = kCorners[next];
        const float distance = (candidate.point - p).squaredNorm();
        if (distance < best_squared) {
            best_squared = distance;
            best = candidate;
        }
    }
    return best;
}

} // namespace

ClosestPoint closest_point(const Vec3f& p, const Vec3f& a, const Vec3f& b,
                           const Vec3f& c) noexcept {
    const Vec3f ab = b - a;
    const Vec3f ac = c - a;
    const Vec3f ap = p - a;
    const float d1 = ab.dot(ap);
    const float d2 = ac.dot(ap);
    if (d1 <= 0.0f && d2 <= 0.0f) return {a, Vec3f::UnitX(), Feature::corner0};

    const Vec3f bp = p - b;
    const float d3 = ab.dot(bp);
    const float d4 = ac.dot(bp);
    if (d3 >= 0.0f && d4 <= d3) return {b, Vec3f::UnitY(), Feature::corner1};

    const Vec3f cp = p - c;
    const float d5 = ab.dot(cp);
    const float d6 = ac.dot(cp);
    if (d6 >= 0.0f && d5 <= d6) return {c, Vec3f::UnitZ(), Feature::corner2};

    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f && d1 > d3)
        return on_side(a, b, d1 / (d1 - d3), 0, 1, Feature::side01);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f && d2 > d6)
        return on_side(c, a, -d6 / (d2 - d6), 2, 0, Feature::side20);
    const float va = d3 * d6 - d5 * d4;
    const float along = d4 - d3;
    const float back = d5 - d6;
    if (va <= 0.0f && along >= 0.0f && back >= 0.0f && along + back > 0.0f)
        return on_side(b, c, along / (along + back), 1, 2, Feature::side12);

    const float sum = va + vb + vc;
    if (!(sum > 0.0f)) return nearest_side(p, a, b, c);
    const float v = vb / sum;
    const float w = vc / sum;
    return {a + v * ab + w * ac, Vec3f(1.0f - v - w, v, w), Feature::face};
}

} // namespace toile::geometry
