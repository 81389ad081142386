#include "geometry/tape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace toile::geometry {
namespace {

/// Where a curve passes nearest to a point: on the side from vertex `index` to the next, at `share`
/// of its length, `distance` off.
struct Passing {
    std::size_t index = 0;
    float share = 0.0f;
    float distance = std::numeric_limits<float>::infinity();
};

Passing nearest_on(const Loop& loop, const Vec3f& point) {
    Passing out;
    const std::size_t count = loop.points.size();
    for (std::size_t i = 0; i + (loop.closed ? 0 : 1) < count; ++i) {
        const Vec3f step = loop.points[(i + 1) % count] - loop.points[i];
        const Vec3f off = point - loop.points[i];
        const float length2 = step.squaredNorm();
        const float share = length2 > 0.0f ? std::clamp(off.dot(step) / length2, 0.0f, 1.0f) : 0.0f;
        const float distance = (off - share * step).norm();
        if (distance < out.distance) out = {i, share, distance};
    }
    return out;
}

/// A curve and where it passes both ends of a tape.
struct CurveThrough {
    const Loop* loop = nullptr;
    Passing from, to;
};

/// The curve that passes nearest to both ends.
CurveThrough curve_through(const std::vector<Loop>& loops, const Vec3f& from, const Vec3f& to) {
    CurveThrough best;
    for (const Loop& loop : loops) {
        const Passing a = nearest_on(loop, from), b = nearest_on(loop, to);
        if (best.loop == nullptr || a.distance + b.distance < best.from.distance + best.to.distance)
            best = {&loop, a, b};
    }
    return best;
}

/// Vertices strictly between two passings of the curve, running forward from a to b; nothing when
/// an open curve has no such way.
std::optional<std::vector<Vec3f>> forward_arc(const Loop& loop, const Passing& a,
                                              const Passing& b) {
    const bool ahead = b.index > a.index || (b.index == a.index && b.share >= a.share);
    if (!loop.closed && !ahead) return std::nullopt;
    const std::size_t count = loop.points.size();
    const std::size_t steps = b.index + (ahead ? 0 : count) - a.index;
    std::vector<Vec3f> out;
    for (std::size_t i = 1; i <= steps; ++i)
        out.push_back(loop.points[(a.index + i) % count]);
    return out;
}

/// How far a way lies to one side: the mean over its length.
double reach(const std::vector<Vec3f>& way, const Vec3f& side) {
    double sum = 0.0, length = 0.0;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        const auto step = static_cast<double>((way[i + 1] - way[i]).norm());
        sum += step * 0.5 * static_cast<double>(side.dot(way[i] + way[i + 1]));
        length += step;
    }
    return length > 0.0 ? sum / length : -std::numeric_limits<double>::infinity();
}

/// Pulls a curve tight: what is hollow is spanned. `turn`: the direction about which a convex
/// curve turns.
std::vector<Vec3f> pull_tight(const std::vector<Vec3f>& curve, const Vec3d& turn) {
    std::vector<Vec3f> out;
    for (const Vec3f& p : curve) {
        while (out.size() >= 2) {
            const Vec3d before = (out.back() - out[out.size() - 2]).cast<double>();
            const Vec3d after = (p - out.back()).cast<double>();
            if (before.cross(after).dot(turn) > 0.0) break;
            out.pop_back();
        }
        if (out.empty() || out.back() != p) out.push_back(p);
    }
    return out;
}

} // namespace

SurfacePart::SurfacePart(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
    for (const Triangle& t : triangles_)
        vertices_.insert(vertices_.end(), t.begin(), t.end());
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    const auto place = [this](std::uint32_t v) {
        return static_cast<std::uint32_t>(std::lower_bound(vertices_.begin(), vertices_.end(), v) -
                                          vertices_.begin());
    };
    for (const Triangle& t : triangles_)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = place(t[k]), b = place(t[(k + 1) % 3]);
            edges_.push_back({std::min(a, b), std::max(a, b)});
        }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

GirthCutter::GirthCutter(std::span<const Vec3f> positions, const SurfacePart& part,
                         const Vec3f& normal)
    : positions_(positions), part_(part), normal_(normal) {
    heights_.reserve(part.vertices().size());
    for (const std::uint32_t v : part.vertices())
        heights_.push_back(normal.dot(positions[v]));
}

template <typename Visit>
void GirthCutter::cut(float offset, const Visit& visit) const {
    const std::span<const std::uint32_t> vertices = part_.vertices();
    for (const auto& [a, b] : part_.edges()) {
        const float below = heights_[a] - offset, above = heights_[b] - offset;
        if ((below < 0.0f) == (above < 0.0f)) continue;
        const Vec3f& p = positions_[vertices[a]];
        visit(Vec3f(p + (below / (below - above)) * (positions_[vertices[b]] - p)));
    }
}

Loop GirthCutter::tape(float offset) const {
    std::vector<Vec3f> points;
    cut(offset, [&points](const Vec3f& p) { points.push_back(p); });
    return {hull_polygon(points, {normal_, offset}), true};
}

float GirthCutter::extent(float offset, const Vec3f& direction) const {
    float most = -std::numeric_limits<float>::infinity();
    cut(offset, [&](const Vec3f& p) { most = std::max(most, direction.dot(p)); });
    return most;
}

double GirthCutter::girth(float offset) const {
    return tape(offset).length();
}

Loop taut_path(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
               const Vec3f& from, const Vec3f& to, const Vec3f& side, Way way) {
    const Loop straight{{from, to}, false};
    const Vec3f normal = (to - from).cross(side);
    if (normal.norm() < 1e-9f) return straight;
    const Plane plane = Plane::through(0.5f * (from + to), normal);
    const std::vector<Loop> loops = slice(positions, triangles, plane);
    const CurveThrough curve = curve_through(loops, from, to);
    if (curve.loop == nullptr) return straight;

    // The two ways from one end to the other; curves run counter-clockwise around the normal, and
    // the way against them turns the other way.
    std::vector<Vec3f> best;
    double most = -std::numeric_limits<double>::infinity();
    for (const bool ahead : {true, false}) {
        auto arc = ahead ? forward_arc(*curve.loop, curve.from, curve.to)
                         : forward_arc(*curve.loop, curve.to, curve.from);
        if (!arc) continue;
        if (!ahead) std::reverse(arc->begin(), arc->end());
        arc->insert(arc->begin(), from);
        arc->push_back(to);
        const double merit = way == Way::shorter ? -Loop{*arc, false}.length() : reach(*arc, side);
        if (merit <= most) continue;
        most = merit;
        best = pull_tight(*arc, (ahead ? 1.0 : -1.0) * plane.normal.cast<double>());
    }
    return best.size() < 2 ? straight : Loop{std::move(best), false};
}

} // namespace toile::geometry
