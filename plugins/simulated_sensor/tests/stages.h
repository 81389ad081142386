// Small scenes with known depths, seen by a camera at the origin that looks along -Z.
#pragma once

#include "simulated_sensor/depth_camera.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

namespace toile::simulated_sensor {

inline std::uint32_t add(Stage& stage, const geometry::TriangleMesh& mesh,
                         Grain grain = Grain::plain) {
    Surface surface;
    surface.name = "test";
    surface.triangles = mesh.triangles;
    surface.rest = mesh.positions;
    surface.look.grain = grain;
    return stage.add(std::move(surface), mesh.positions);
}

/// A large square through (0, 0, -depth), turned by `tilt` about the y axis.
inline geometry::TriangleMesh tilted_plane(float depth, float tilt) {
    const Quatf turn(Eigen::AngleAxisf(tilt, Vec3f::UnitY()));
    geometry::TriangleMesh mesh;
    constexpr float kHalf = 30.0f;
    for (const auto& [x, y] :
         {std::pair{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}})
        mesh.positions.push_back(turn * Vec3f(x, y, 0.0f) + Vec3f(0.0f, 0.0f, -depth));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// Depth of that plane under a ray of length 1 along the axis.
inline double plane_depth(const Vec3f& ray, double depth, double tilt) {
    const Vec3d normal(std::sin(tilt), 0.0, std::cos(tilt));
    return normal.dot(Vec3d(0, 0, -depth)) / normal.dot(ray.cast<double>());
}

inline CameraSettings bare_camera(CameraModel model = CameraModel::kinect_v1) {
    CameraSettings out = camera_of(model);
    out.noise = no_noise();
    return out;
}

/// Looks and measures once, unrounded.
inline void see(DepthCamera& camera, const Stage& stage, std::uint32_t frame = 0,
                const RowLoop& rows = &serial_rows) {
    camera.look(stage, rows);
    camera.measure(stage, frame, rows, false);
}

struct Spread {
    double mean = 0.0;
    double deviation = 0.0;
    std::size_t count = 0;
};
inline Spread spread_of(const std::vector<double>& values) {
    Spread out;
    out.count = values.size();
    for (const double v : values)
        out.mean += v / static_cast<double>(values.size());
    double sum = 0.0;
    for (const double v : values)
        sum += (v - out.mean) * (v - out.mean);
    out.deviation = std::sqrt(sum / static_cast<double>(values.size() - 1));
    return out;
}

} // namespace toile::simulated_sensor
