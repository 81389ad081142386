// Depth pictures of a surface, without errors or with even noise, for tests of scanning.
#pragma once

#include "core/random.h"
#include "geometry/nearest_surface.h"
#include "imaging/camera.h"
#include "support/meshes.h"

#include <limits>

namespace toile::test {

inline imaging::Intrinsics small_depth_camera() {
    imaging::Intrinsics out;
    out.width = 160;
    out.height = 200;
    out.fx = out.fy = 260.0;
    out.cx = 79.5;
    out.cy = 99.5;
    return out;
}

/// Depth of the surface from a camera at `world_from_camera`; NaN where there is nothing.
inline std::vector<float> depth_picture(const geometry::NearestSurface& surface,
                                        const imaging::Intrinsics& camera,
                                        const Eigen::Isometry3d& world_from_camera,
                                        float noise_m = 0.0f, std::uint64_t seed = 1) {
    Random random(seed);
    std::vector<float> out;
    const Eigen::Isometry3f pose = world_from_camera.cast<float>();
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const Vec3f ray(static_cast<float>((x - camera.cx) / camera.fx),
                            static_cast<float>((camera.cy - y) / camera.fy), -1.0f);
            const auto hit = surface.first_hit(pose.translation(), pose.linear() * ray);
            const auto error = static_cast<float>(noise_m * random.uniform(-1.0, 1.0));
            out.push_back(hit ? hit->distance + error : std::numeric_limits<float>::quiet_NaN());
        }
    return out;
}

/// A lump 0.6 m high that looks different from every side.
inline geometry::TriangleMesh lump() {
    geometry::TriangleMesh out;
    const auto add = [&](float radius, const Vec3f& scale, const Vec3f& at) {
        const geometry::TriangleMesh ball = sphere(radius, 5);
        const auto first = static_cast<std::uint32_t>(out.positions.size());
        for (const Vec3f& p : ball.positions)
            out.positions.emplace_back(p.cwiseProduct(scale) + at);
        for (const Triangle& t : ball.triangles)
            out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    };
    add(0.15f, {1.0f, 1.6f, 0.8f}, {0.0f, 0.0f, 0.0f});
    add(0.08f, {1.0f, 1.0f, 1.0f}, {0.03f, 0.24f, 0.02f});
    add(0.06f, {1.0f, 1.6f, 1.0f}, {0.15f, 0.02f, 0.03f});
    add(0.05f, {1.0f, 1.0f, 1.4f}, {-0.11f, -0.12f, 0.09f});
    return out;
}

/// A camera `distance` metres from the origin that looks at it, `angle` round the vertical.
inline Eigen::Isometry3d camera_around(double angle, double distance = 1.0) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.rotate(Eigen::AngleAxisd(angle, Vec3d::UnitY()));
    out.translate(Vec3d(0.0, 0.0, distance));
    return out;
}

} // namespace toile::test
