#include "geometry/slice.h"

#include <algorithm>
#include <cmath>

namespace toile::geometry {
namespace {

// An edge that the plane crosses, by its vertices: the one below and the one above.
struct Crossing {
    std::uint32_t low, high;
    auto operator<=>(const Crossing&) const = default;
};

// Part of a curve within one triangle, from one crossed edge to another.
struct Segment {
    Crossing start, end;
    std::uint32_t triangle = 0;
    bool operator<(const Segment& other) const { return start < other.start; }
};

Crossing crossing(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

class Slicer {
  public:
    Slicer(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
           const Plane& plane)
        : positions_(positions) {
        heights_.reserve(positions.size());
        const Vec3d normal = plane.normal.cast<double>();
        for (const Vec3f& p : positions)
            heights_.push_back(normal.dot(p.cast<double>()) - static_cast<double>(plane.offset));
        for (std::uint32_t i = 0; i < triangles.size(); ++i)
            add_segment(triangles[i], i);
        std::sort(segments_.begin(), segments_.end());
        used_.assign(segments_.size(), 0);
    }

    std::vector<Loop> run() {
        // Curves that begin at a border first, then the closed ones.
        std::vector<Crossing> ends;
        for (const Segment& s : segments_)
            ends.push_back(s.end);
        std::sort(ends.begin(), ends.end());
        std::vector<Loop> loops;
        for (std::size_t i = 0; i < segments_.size(); ++i)
            if (used_[i] == 0 && !std::binary_search(ends.begin(), ends.end(), segments_[i].start))
                loops.push_back(follow(i));
        for (std::size_t i = 0; i < segments_.size(); ++i)
            if (used_[i] == 0) loops.push_back(follow(i));
        return loops;
    }

  private:
    [[nodiscard]] bool above(std::uint32_t v) const { return heights_[v] >= 0.0; }

    // Neighbours run through their common edge in opposite directions, so that starting where a
    // triangle's outline falls through the plane and ending where it rises makes segments meet
    // head to tail.
    void add_segment(const Triangle& t, std::uint32_t triangle) {
        Segment segment{};
        segment.triangle = triangle;
        int crossed = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k];
            const std::uint32_t b = t[(k + 1) % 3];
            if (above(a) == above(b)) continue;
            (above(a) ? segment.start : segment.end) = crossing(a, b);
            ++crossed;
        }
        if (crossed == 2) segments_.push_back(segment);
    }

    [[nodiscard]] Vec3f point(const Crossing& c) const {
        const double a = heights_[c.low];
        const double b = heights_[c.high];
        const double t = a / (a - b);
        const Vec3d p = positions_[c.low].cast<double>();
        return (p + t * (positions_[c.high].cast<double>() - p)).cast<float>();
    }

    Loop follow(std::size_t first) {
        Loop loop;
        const Crossing begin = segments_[first].start;
        std::size_t i = first;
        for (;;) {
            used_[i] = 1;
            loop.points.push_back(point(segments_[i].start));
            loop.triangles.push_back(segments_[i].triangle);
            const Crossing end = segments_[i].end;
            if (end == begin) {
                loop.closed = true;
                return loop;
            }
            auto next = std::lower_bound(segments_.begin(), segments_.end(), Segment{end, end});
            while (next != segments_.end() && next->start == end &&
                   used_[static_cast<std::size_t>(next - segments_.begin())] != 0)
                ++next;
            if (next == segments_.end() || next->start != end) {
                loop.points.push_back(point(end));
                return loop;
            }
            i = static_cast<std::size_t>(next - segments_.begin());
        }
    }

    std::span<const Vec3f> positions_;
    std::vector<double> heights_; // over the plane
    std::vector<Segment> segments_;
    std::vector<char> used_;
};

double cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

} // namespace

double Loop::length() const {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        sum += static_cast<double>((points[i + 1] - points[i]).norm());
    if (closed && points.size() > 1)
        sum += static_cast<double>((points.front() - points.back()).norm());
    return sum;
}

Vec3f Loop::centroid() const {
    Vec3d sum = Vec3d::Zero();
    double weight = 0.0;
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (!closed && i + 1 == count) break;
        const Vec3d a = points[i].cast<double>();
        const Vec3d b = points[(i + 1) % count].cast<double>();
        sum += (b - a).norm() * 0.5 * (a + b);
        weight += (b - a).norm();
    }
    if (weight > 0.0) return (sum / weight).cast<float>();
    return points.empty() ? Vec3f(Vec3f::Zero()) : points.front();
}

std::vector<Loop> slice(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                        const Plane& plane) {
    return Slicer(positions, triangles, plane).run();
}

std::vector<Vec3f> hull_polygon(std::span<const Vec3f> points, const Plane& plane) {
    // Coordinates in the plane; (u, v, normal) is right-handed.
    const Vec3d n = plane.normal.cast<double>();
    const Vec3d u = n.unitOrthogonal();
    const Vec3d v = n.cross(u);
    std::vector<Eigen::Vector2d> flat;
    flat.reserve(points.size());
    for (const Vec3f& p : points)
        flat.emplace_back(u.dot(p.cast<double>()), v.dot(p.cast<double>()));
    const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
    };
    std::sort(flat.begin(), flat.end(), less);
    flat.erase(std::unique(flat.begin(), flat.end()), flat.end());

    // Andrew's monotone chain.
    std::vector<Eigen::Vector2d> hull;
    const auto add = [&hull](const Eigen::Vector2d& p, std::size_t keep) {
        while (hull.size() >= keep + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const Eigen::Vector2d& p : flat)
        add(p, 0);
    if (flat.size() > 1) {
        const std::size_t lower = hull.size() - 1;
        for (auto it = flat.rbegin() + 1; it != flat.rend(); ++it)
            add(*it, lower);
        hull.pop_back(); // the first point again
    }
    std::vector<Vec3f> out;
    out.reserve(hull.size());
    for (const Eigen::Vector2d& p : hull)
        out.emplace_back(
            (p.x() * u + p.y() * v + static_cast<double>(plane.offset) * n).cast<float>());
    return out;
}

double hull_girth(std::span<const Vec3f> points, const Plane& plane) {
    return Loop{hull_polygon(points, plane), true}.length();
}

} // namespace toile::geometry
