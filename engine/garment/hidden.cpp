#include "garment/hidden.h"

#include "geometry/mesh.h"
#include "geometry/nearest_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace toile::garment {
namespace {

constexpr int kDirections = 48;

/// Evenly over the half space around z, none nearer than 3 degrees to its edge (a spiral).
std::array<Vec3f, kDirections> half_space() {
    std::array<Vec3f, kDirections> out;
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int i = 0; i < kDirections; ++i) {
        const double z = 1.0 - 0.95 * (i + 0.5) / kDirections, r = std::sqrt(1.0 - z * z);
        out[static_cast<std::size_t>(i)] =
            Vec3d(r * std::cos(golden * i), r * std::sin(golden * i), z).cast<float>();
    }
    return out;
}

/// All that stands between the inner garment and a camera, as one surface.
geometry::NearestSurface screen(const ClothSurface& inner, std::span<const ClothSurface> over,
                                const ClothSurface& body) {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    const auto add = [&](const ClothSurface& surface) {
        const auto base = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), surface.positions.begin(), surface.positions.end());
        for (const Triangle& t : surface.triangles)
            triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    };
    add(inner);
    add(body);
    for (const ClothSurface& surface : over)
        add(surface);
    return {positions, triangles};
}

/// Distance along the edges from the nearest vertex that is seen; m, infinity: nothing is.
std::vector<float> distance_to_seen(const ClothSurface& inner, std::span<const std::uint8_t> seen) {
    const auto around = geometry::vertex_adjacency(inner.positions.size(), inner.triangles);
    std::vector<float> out(seen.size(), std::numeric_limits<float>::infinity());
    using Entry = std::pair<float, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (std::uint32_t v = 0; v < seen.size(); ++v)
        if (seen[v] != 0) {
            out[v] = 0.0f;
            open.emplace(0.0f, v);
        }
    while (!open.empty()) {
        const auto [distance, v] = open.top();
        open.pop();
        if (distance > out[v]) continue;
        for (std::uint32_t k = around.first[v]; k < around.first[v + 1]; ++k) {
            const std::uint32_t w = around.neighbours[k];
            const float next = distance + (inner.positions[w] - inner.positions[v]).norm();
            if (next >= out[w]) continue;
            out[w] = next;
            open.emplace(next, w);
        }
    }
    return out;
}

} // namespace

std::vector<std::uint8_t> hidden_triangles(const ClothSurface& inner,
                                           std::span<const Vec3f> inner_normals,
                                           std::span<const ClothSurface> over,
                                           const ClothSurface& body, const HiddenOptions& options) {
    std::vector<std::uint8_t> out(inner.triangles.size(), 0);
    if (over.empty()) return out;
    const geometry::NearestSurface surface = screen(inner, over, body);
    const std::array<Vec3f, kDirections> directions = half_space();
    std::vector<std::uint8_t> seen(inner.positions.size(), 1);
    for (std::size_t v = 0; v < seen.size(); ++v) {
        const Vec3f& normal = inner_normals[v];
        if (normal.squaredNorm() < 0.5f) continue;
        const Quatf turn = Quatf::FromTwoVectors(Vec3f::UnitZ(), normal);
        const Vec3f from = inner.positions[v] + options.offset_m * normal;
        const bool passes = std::any_of(directions.begin(), directions.end(), [&](const Vec3f& d) {
            return !surface.blocked(from, turn * d, 0.0f, options.reach_m);
        });
        seen[v] = passes ? 1 : 0;
    }
    const std::vector<float> distance = distance_to_seen(inner, seen);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Triangle& t = inner.triangles[i];
        const bool deep = std::all_of(
            t.begin(), t.end(), [&](std::uint32_t v) { return distance[v] > options.margin_m; });
        out[i] = deep ? 1 : 0;
    }
    return out;
}

} // namespace toile::garment
