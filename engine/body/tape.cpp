#include "body/tape.h"

#include <algorithm>
#include <cmath>

namespace toile::body {
namespace {

constexpr float kSteepest = 5.0f; // bound on how a cut slides along an edge that lies flat in it

/// Where an edge crosses the plane.
struct Crossing {
    std::uint32_t from, to;
    float t;
    Eigen::Vector2d place; ///< in the plane
};

/// The convex hull's corners, counter-clockwise (Andrew's monotone chain).
std::vector<std::size_t> convex_hull(const std::vector<Crossing>& points) {
    std::vector<std::size_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const auto &p = points[a].place, &q = points[b].place;
        if (p.x() != q.x()) return p.x() < q.x();
        if (p.y() != q.y()) return p.y() < q.y();
        return a < b;
    });
    const auto turn = [&](std::size_t o, std::size_t a, std::size_t b) {
        const Eigen::Vector2d u = points[a].place - points[o].place;
        const Eigen::Vector2d v = points[b].place - points[o].place;
        return u.x() * v.y() - u.y() * v.x();
    };
    std::vector<std::size_t> hull;
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t base = hull.size();
        for (const auto i : order) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), i) <= 0.0)
                hull.pop_back();
            hull.push_back(i);
        }
        hull.pop_back();
        std::reverse(order.begin(), order.end());
    }
    return hull;
}

} // namespace

Measured tape_girth(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                    const Vec3f& point, const Vec3f& axis, const std::uint32_t* rider) {
    const Vec3f u = axis.unitOrthogonal(), w = axis.cross(u);
    std::vector<Crossing> cut;
    for (const auto& t : triangles) {
        std::array<float, 3> side{};
        for (std::size_t k = 0; k < 3; ++k)
            side[k] = (positions[t[k]] - point).dot(axis);
        for (std::size_t k = 0; k < 3; ++k) {
            const float a = side[k], b = side[(k + 1) % 3];
            if ((a < 0.0f) == (b < 0.0f)) continue;
            const auto from = t[k], to = t[(k + 1) % 3];
            const float s = a / (a - b);
            const Vec3f c = positions[from] + s * (positions[to] - positions[from]) - point;
            cut.push_back({from, to, s, {c.dot(u), c.dot(w)}});
        }
    }
    Measured out;
    if (cut.size() < 3) return out;
    const auto hull = convex_hull(cut);
    float plane_slope = 0.0f;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Crossing& c = cut[hull[i]];
        const auto& before = cut[hull[(i + hull.size() - 1) % hull.size()]].place;
        const auto& after = cut[hull[(i + 1) % hull.size()]].place;
        out.value += (after - c.place).norm();
        const Eigen::Vector2d g = (c.place - before).normalized() + (c.place - after).normalized();
        if (!g.allFinite()) continue;
        // The corner follows its edge's ends, and slides along the edge to stay in the plane.
        const Vec3f pull = static_cast<float>(g.x()) * u + static_cast<float>(g.y()) * w;
        const Vec3f edge = positions[c.to] - positions[c.from];
        const float slide = std::clamp(pull.dot(edge) / edge.dot(axis), -kSteepest, kSteepest);
        const Vec3f across = pull - slide * axis;
        out.slope.emplace_back(c.from, (1.0f - c.t) * across);
        out.slope.emplace_back(c.to, c.t * across);
        plane_slope += slide;
    }
    if (rider != nullptr) {
        out.slope.emplace_back(*rider, plane_slope * axis);
        return out;
    }
    const auto corners = static_cast<float>(hull.size());
    for (const auto i : hull) {
        out.slope.emplace_back(cut[i].from, (1.0f - cut[i].t) * plane_slope / corners * axis);
        out.slope.emplace_back(cut[i].to, cut[i].t * plane_slope / corners * axis);
    }
    return out;
}

Measured tape_distance(std::span<const Vec3f> positions, std::uint32_t a, std::uint32_t b) {
    const Vec3f d = positions[b] - positions[a];
    const Vec3f unit = d.normalized();
    return {d.norm(), {{a, -unit}, {b, unit}}};
}

Measured tape_rise(std::span<const Vec3f> positions, std::uint32_t a, std::uint32_t b,
                   const Vec3f& axis) {
    return {(positions[b] - positions[a]).dot(axis), {{a, -axis}, {b, axis}}};
}

Measured tape_volume(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    Measured out;
    std::vector<Vec3f> slope(positions.size(), Vec3f::Zero());
    for (const auto& t : triangles) {
        const Vec3f &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
        out.value += static_cast<double>(a.dot(b.cross(c))) / 6.0;
        slope[t[0]] += b.cross(c) / 6.0f;
        slope[t[1]] += c.cross(a) / 6.0f;
        slope[t[2]] += a.cross(b) / 6.0f;
    }
    for (std::uint32_t v = 0; v < slope.size(); ++v)
        if (!slope[v].isZero(0.0f)) out.slope.emplace_back(v, slope[v]);
    return out;
}

} // namespace toile::body
