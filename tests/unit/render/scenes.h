// Small scenes and readings of pictures for the renderer's tests.
#pragma once

#include "render/renderer.h"
#include "render/views.h"

#include <array>
#include <cstdint>

namespace toile::test {

inline constexpr float kTau = 6.2831853f;

struct MeshData {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;

    [[nodiscard]] render::MeshDescription description() const {
        render::MeshDescription d;
        d.positions = positions;
        d.triangles = triangles;
        return d;
    }
};

/// A closed sphere, counter-clockwise outside.
inline MeshData sphere(const Vec3f& centre, float radius, int rings = 24, int sides = 48) {
    MeshData m;
    for (int i = 0; i <= rings; ++i) {
        const float polar = 0.5f * kTau * static_cast<float>(i) / static_cast<float>(rings);
        for (int j = 0; j < sides; ++j) {
            const float a = kTau * static_cast<float>(j) / static_cast<float>(sides);
            m.positions.push_back(centre + radius * Vec3f(std::sin(polar) * std::sin(a),
                                                          std::cos(polar),
                                                          std::sin(polar) * std::cos(a)));
        }
    }
    const auto at = [sides](int i, int j) {
        return static_cast<std::uint32_t>(i * sides + (j + sides) % sides);
    };
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sides; ++j) {
            m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return m;
}

/// A square facing +Z.
inline MeshData square(const Vec3f& centre, float half) {
    return {{centre + Vec3f(-half, -half, 0), centre + Vec3f(half, -half, 0),
             centre + Vec3f(half, half, 0), centre + Vec3f(-half, half, 0)},
            {{0, 1, 2}, {0, 2, 3}}};
}

/// Looks along -Z from `distance` before the point.
inline render::Camera camera_at(const Vec3f& target, float distance, float tangent = 0.3f) {
    render::Camera c;
    c.world_from_camera.translation = target + Vec3f(0, 0, distance);
    c.left = c.bottom = -tangent;
    c.right = c.top = tangent;
    return c;
}

inline render::Lighting only_key(const Vec3f& direction) {
    render::Lighting l;
    l.key_direction = direction;
    l.key_color = Vec3f::Ones();
    l.key_size = 0.0f;
    l.fill_color = l.rim_color = l.sky = l.ground = Vec3f::Zero();
    return l;
}

inline std::array<int, 3> pixel(const imaging::Image& image, int x, int y) {
    const auto i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(x));
    return {image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]};
}

/// FNV-1a over the bytes.
inline std::uint64_t hash(const imaging::Image& image) {
    std::uint64_t h = 0xcbf29ce484222325ull;
    for (const std::uint8_t byte : image.pixels)
        h = (h ^ byte) * 0x100000001b3ull;
    return h;
}

} // namespace toile::test
