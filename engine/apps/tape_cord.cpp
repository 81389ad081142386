#include "apps/tape_cord.h"

#include <cmath>
#include <numbers>

namespace toile::apps {
namespace {

constexpr std::uint32_t kSides = 8;
constexpr std::uint32_t kRings = 6; // of a knob
constexpr float kKnob = 2.0f;       // radii of the cord

constexpr float kPi = std::numbers::pi_v<float>;

/// The points without those that repeat the one before.
std::vector<Vec3f> distinct(const geometry::Loop& loop) {
    constexpr float kLeast = 1e-5f; // metres
    std::vector<Vec3f> out;
    for (const Vec3f& p : loop.points)
        if (out.empty() || (p - out.back()).norm() > kLeast) out.push_back(p);
    while (loop.closed && out.size() > 1 && (out.back() - out.front()).norm() <= kLeast)
        out.pop_back();
    return out;
}

/// Joins rings of kSides vertices, from `first` on, each to the next and the last to `last`.
void join(geometry::TriangleMesh& mesh, std::uint32_t first, std::uint32_t rings, bool closed) {
    const auto at = [&](std::uint32_t ring, std::uint32_t side) {
        return first + ring % rings * kSides + side % kSides;
    };
    for (std::uint32_t i = 0; i + (closed ? 0 : 1) < rings; ++i)
        for (std::uint32_t k = 0; k < kSides; ++k) {
            mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
        }
}

void add_knob(geometry::TriangleMesh& mesh, const Vec3f& centre, float radius) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t r = 0; r <= kRings; ++r)
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const float polar = kPi * static_cast<float>(r) / kRings;
            const float around = 2.0f * kPi * static_cast<float>(k) / kSides;
            mesh.normals.emplace_back(std::sin(polar) * std::cos(around),
                                      std::sin(polar) * std::sin(around), -std::cos(polar));
            mesh.positions.emplace_back(centre + radius * mesh.normals.back());
        }
    join(mesh, first, kRings + 1, false);
}

} // namespace

geometry::TriangleMesh cord(const geometry::Loop& loop, float radius_m) {
    geometry::TriangleMesh out;
    const std::vector<Vec3f> points = distinct(loop);
    const std::size_t n = points.size();
    if (n < 2) return out;
    Vec3f side = (points[1] - points[0]).unitOrthogonal();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3f& before = points[i > 0 ? i - 1 : (loop.closed ? n - 1 : 0)];
        const Vec3f& after = points[i + 1 < n ? i + 1 : (loop.closed ? 0 : n - 1)];
        Vec3f along = after - before;
        if (along.norm() < 1e-6f) along = points[i] - before; // turns back on itself
        along.normalize();
        const Vec3f carried = side - side.dot(along) * along;
        side = carried.norm() > 1e-3f ? Vec3f(carried.normalized()) : along.unitOrthogonal();
        const Vec3f other = along.cross(side);
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const float angle = 2.0f * kPi * static_cast<float>(k) / kSides;
            out.normals.emplace_back(std::cos(angle) * side + std::sin(angle) * other);
            out.positions.emplace_back(points[i] + radius_m * out.normals.back());
        }
    }
    join(out, 0, static_cast<std::uint32_t>(n), loop.closed);
    if (!loop.closed) {
        add_knob(out, points.front(), kKnob * radius_m);
        add_knob(out, points.back(), kKnob * radius_m);
    }
    return out;
}

} // namespace toile::apps
