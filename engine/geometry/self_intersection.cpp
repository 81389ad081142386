#include "geometry/self_intersection.h"

#include "core/error.h"

#include <algorithm>

namespace toile::geometry {
namespace {

struct Box {
    Vec3f low, high;
    std::uint32_t triangle;
};

/// Six times the volume of a tetrahedron; its sign says on which side of (a, b, c) d lies.
double side_of(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return (b - a).cross(c - a).dot(d - a);
}

/// Whether the way from p to q passes through the inside of a triangle.
bool pierces(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& t) {
    const double before = side_of(t[0], t[1], t[2], p), behind = side_of(t[0], t[1], t[2], q);
    if (!((before > 0.0 && behind < 0.0) || (before < 0.0 && behind > 0.0))) return false;
    const double u = side_of(p, q, t[0], t[1]);
    const double v = side_of(p, q, t[1], t[2]);
    const double w = side_of(p, q, t[2], t[0]);
    return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

bool any_side_pierces(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (pierces(a[k], a[(k + 1) % 3], b)) return true;
    return false;
}

bool share_a_corner(const Triangle& a, const Triangle& b) {
    return std::any_of(a.begin(), a.end(), [&](std::uint32_t v) {
        return std::find(b.begin(), b.end(), v) != b.end();
    });
}

std::vector<Box> boxes_of(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    std::vector<Box> out;
    out.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        Box box{Vec3f::Constant(1e30f), Vec3f::Constant(-1e30f), i};
        for (const std::uint32_t v : triangles[i]) {
            if (v >= positions.size())
                throw Error("self-intersections: triangle " + std::to_string(i) + " names vertex " +
                            std::to_string(v) + " of " + std::to_string(positions.size()));
            if (!positions[v].allFinite())
                throw Error("self-intersections: vertex " + std::to_string(v) + " is not finite");
            box.low = box.low.cwiseMin(positions[v]);
            box.high = box.high.cwiseMax(positions[v]);
        }
        out.push_back(box);
    }
    return out;
}

} // namespace

bool triangles_cut(const std::array<Vec3f, 3>& a, const std::array<Vec3f, 3>& b) {
    const auto precise = [](const std::array<Vec3f, 3>& t) {
        return std::array<Vec3d, 3>{t[0].cast<double>(), t[1].cast<double>(), t[2].cast<double>()};
    };
    const auto c = precise(a), d = precise(b);
    return any_side_pierces(c, d) || any_side_pierces(d, c);
}

std::vector<std::uint8_t> self_intersecting(std::span<const Vec3f> positions,
                                            std::span<const Triangle> triangles) {
    std::vector<std::uint8_t> out(triangles.size(), 0);
    std::vector<Box> boxes = boxes_of(positions, triangles);
    // Swept along the height, in which clothes are longest.
    std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) {
        return a.low.y() != b.low.y() ? a.low.y() < b.low.y() : a.triangle < b.triangle;
    });
    const auto corners = [&](std::uint32_t i) {
        const Triangle& t = triangles[i];
        return std::array<Vec3f, 3>{positions[t[0]], positions[t[1]], positions[t[2]]};
    };
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box& a = boxes[i];
        for (std::size_t j = i + 1; j < boxes.size() && boxes[j].low.y() <= a.high.y(); ++j) {
            const Box& b = boxes[j];
            const bool apart = a.low.x() > b.high.x() || b.low.x() > a.high.x() ||
                               a.low.z() > b.high.z() || b.low.z() > a.high.z() ||
                               (out[a.triangle] != 0 && out[b.triangle] != 0);
            if (apart || share_a_corner(triangles[a.triangle], triangles[b.triangle])) continue;
            if (triangles_cut(corners(a.triangle), corners(b.triangle)))
                out[a.triangle] = out[b.triangle] = 1;
        }
    }
    return out;
}

} // namespace toile::geometry
