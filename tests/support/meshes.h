// Small surfaces with known answers.
#pragma once

#include "geometry/mesh.h"

#include <cmath>
#include <map>
#include <numbers>

namespace toile::test {

/// Axis-aligned box from `low` to `high`, 12 triangles, outwards.
inline geometry::TriangleMesh box(const Vec3f& low, const Vec3f& high) {
    geometry::TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back((i & 1) != 0 ? high.x() : low.x(),
                                    (i & 2) != 0 ? high.y() : low.y(),
                                    (i & 4) != 0 ? high.z() : low.z());
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Sphere from an octahedron split `levels` times.
inline geometry::TriangleMesh sphere(float radius, int levels) {
    geometry::TriangleMesh mesh;
    mesh.positions = {Vec3f(1, 0, 0),  Vec3f(-1, 0, 0), Vec3f(0, 1, 0),
                      Vec3f(0, -1, 0), Vec3f(0, 0, 1),  Vec3f(0, 0, -1)};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto key = std::minmax(a, b);
            const auto [it, fresh] =
                middles.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
            if (fresh)
                mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]).normalized());
            return it->second;
        };
        std::vector<Triangle> split;
        for (const Triangle& t : mesh.triangles) {
            const std::uint32_t ab = middle(t[0], t[1]);
            const std::uint32_t bc = middle(t[1], t[2]);
            const std::uint32_t ca = middle(t[2], t[0]);
            split.insert(split.end(),
                         {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(split);
    }
    for (Vec3f& p : mesh.positions)
        p *= radius;
    return mesh;
}

/// Flat grid in the plane z = 0 over [0, width] x [0, height], facing +Z, (nx + 1)(ny + 1)
/// vertices.
inline geometry::TriangleMesh grid(float width, float height, int nx, int ny) {
    geometry::TriangleMesh mesh;
    for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i)
            mesh.positions.emplace_back(width * static_cast<float>(i) / static_cast<float>(nx),
                                        height * static_cast<float>(j) / static_cast<float>(ny),
                                        0.0f);
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (nx + 1) + i);
            const auto c = a + static_cast<std::uint32_t>(nx) + 1;
            mesh.triangles.push_back({a, a + 1, c + 1});
            mesh.triangles.push_back({a, c + 1, c});
        }
    return mesh;
}

/// Open tube around the y axis: ellipse of half axes a (x) and b (z), from y = 0 to `height`.
inline geometry::TriangleMesh tube(float a, float b, float height, int around, int along) {
    geometry::TriangleMesh mesh;
    for (int j = 0; j <= along; ++j)
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / around;
            mesh.positions.emplace_back(a * static_cast<float>(std::cos(angle)),
                                        height * static_cast<float>(j) / static_cast<float>(along),
                                        b * static_cast<float>(std::sin(angle)));
        }
    const auto at = [around](int i, int j) {
        return static_cast<std::uint32_t>(j * around + i % around);
    };
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < around; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
        }
    return mesh;
}

} // namespace toile::test
