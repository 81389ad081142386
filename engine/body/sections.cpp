#include "body/sections.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace toile::body {
namespace {

Outline make_outline(geometry::Loop loop) {
    Outline out;
    out.points = std::move(loop.points);
    out.low = Vec2f::Constant(std::numeric_limits<float>::max());
    out.high = -out.low;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    const Vec3f& base = out.points.front();
    for (std::size_t i = 0; i < out.points.size(); ++i) {
        const Vec3d p = (out.points[i] - base).cast<double>();
        const Vec3d q = (out.points[(i + 1) % out.points.size()] - base).cast<double>();
        // Seen from above (against +y) x points right and z down, so that the sign turns.
        const double cross = p.z() * q.x() - p.x() * q.z();
        out.area += 0.5 * cross;
        moment += cross / 6.0 * Eigen::Vector2d(p.x() + q.x(), p.z() + q.z());
        const Vec2f flat(out.points[i].x(), out.points[i].z());
        out.low = out.low.cwiseMin(flat);
        out.high = out.high.cwiseMax(flat);
    }
    if (out.area != 0.0) moment /= out.area;
    out.centroid = Vec2f(base.x(), base.z()) + moment.cast<float>();
    return out;
}

} // namespace

double Outline::girth() const {
    return geometry::hull_girth(points, {Vec3f::UnitY(), points.front().y()});
}

bool Outline::contains(const Vec2f& p) const {
    bool inside = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f& a = points[i];
        const Vec3f& b = points[(i + 1) % points.size()];
        if ((a.z() > p.y()) == (b.z() > p.y())) continue;
        if (p.x() < a.x() + (p.y() - a.z()) / (b.z() - a.z()) * (b.x() - a.x())) inside = !inside;
    }
    return inside;
}

Sections::Sections(std::span<const Vec3f> positions, std::span<const Triangle> triangles)
    : positions_(positions), triangles_(triangles.begin(), triangles.end()) {
    const auto lowest = [&](const Triangle& t) {
        return std::min({positions[t[0]].y(), positions[t[1]].y(), positions[t[2]].y()});
    };
    std::stable_sort(triangles_.begin(), triangles_.end(),
                     [&](const Triangle& a, const Triangle& b) { return lowest(a) < lowest(b); });
    floor_ = std::numeric_limits<float>::max();
    top_ = -floor_;
    for (const Triangle& t : triangles_) {
        lows_.push_back(lowest(t));
        highs_.push_back(std::max({positions[t[0]].y(), positions[t[1]].y(), positions[t[2]].y()}));
        tallest_ = std::max(tallest_, highs_.back() - lows_.back());
        floor_ = std::min(floor_, lows_.back());
        top_ = std::max(top_, highs_.back());
    }
}

std::vector<Outline> Sections::at(float y) const {
    const auto first = std::lower_bound(lows_.begin(), lows_.end(), y - tallest_);
    const auto last = std::upper_bound(first, lows_.end(), y);
    std::vector<Triangle> met;
    for (auto i = static_cast<std::size_t>(first - lows_.begin());
         i < static_cast<std::size_t>(last - lows_.begin()); ++i)
        if (highs_[i] >= y) met.push_back(triangles_[i]);
    // The slicer looks at every vertex that it is given: give it those that are met.
    std::vector<Vec3f> corners;
    corners.reserve(3 * met.size());
    std::vector<std::uint32_t> used;
    for (const Triangle& t : met)
        used.insert(used.end(), t.begin(), t.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const std::uint32_t v : used)
        corners.push_back(positions_[v]);
    for (Triangle& t : met)
        for (std::uint32_t& v : t)
            v = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) -
                                           used.begin());
    std::vector<Outline> out;
    for (geometry::Loop& loop : geometry::slice(corners, met, {Vec3f::UnitY(), y})) {
        if (!loop.closed || loop.points.size() < 3) continue;
        Outline outline = make_outline(std::move(loop));
        if (outline.area > 0.0) out.push_back(std::move(outline));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Outline& a, const Outline& b) { return a.area > b.area; });
    return out;
}

Outline Sections::follow(const Outline& from, float y) const {
    std::vector<Outline> outlines = at(y);
    if (outlines.empty())
        throw Error("the body has no section at a height of " + std::to_string(y));
    Outline* best = nullptr;
    float least = std::numeric_limits<float>::max();
    for (Outline& o : outlines) {
        const float distance =
            o.contains(from.centroid) ? 0.0f : (o.centroid - from.centroid).norm();
        if (distance >= least) continue;
        least = distance;
        best = &o;
    }
    return std::move(*best);
}

std::pair<Vec3f, Vec3f> nearest_points(const Outline& a, const Outline& b) {
    std::pair<Vec3f, Vec3f> out;
    float least = std::numeric_limits<float>::max();
    for (const Vec3f& p : a.points)
        for (const Vec3f& q : b.points) {
            const float d = (p - q).squaredNorm();
            if (d >= least) continue;
            least = d;
            out = {p, q};
        }
    return out;
}

} // namespace toile::body
