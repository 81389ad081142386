// One depth picture made ready for scanning: the subject alone, smoothed, with normals.
//
// Camera frame as everywhere (looks along -Z, +Y up); pixels of a window around the subject.
#pragma once

#include "core/types.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace toile::scan {

using Rgba8 = std::array<std::uint8_t, 4>;

/// A window of a pinhole camera's picture: without distortion, its corner at (0, 0).
struct Window {
    int width = 0, height = 0;
    float fx = 0, fy = 0, cx = 0, cy = 0;

    [[nodiscard]] Vec3f ray(float x, float y) const { ///< point at depth 1
        return {(x - cx) / fx, -(y - cy) / fy, -1.0f};
    }
    /// Pixel of a point in the camera frame. False when it is behind the camera or outside.
    [[nodiscard]] bool pixel(const Vec3f& p, int& x, int& y) const {
        if (p.z() > -0.05f) return false;
        const float u = cx - fx * p.x() / p.z(), v = cy + fy * p.y() / p.z();
        x = static_cast<int>(std::floor(u + 0.5f));
        y = static_cast<int>(std::floor(v + 0.5f));
        return u > -0.5f && v > -0.5f && x < width && y < height;
    }
    /// The same for any pixel of the plane.
    [[nodiscard]] bool project(const Vec3f& p, float& u, float& v) const {
        if (p.z() > -0.05f) return false;
        u = cx - fx * p.x() / p.z();
        v = cy + fy * p.y() / p.z();
        return true;
    }
    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

/// What a pixel beside the subject shows.
enum class Beyond : std::uint8_t { subject, unknown, nothing, scene };

struct DepthView {
    Window camera;
    std::vector<float> depth; ///< (pixels) of the subject, metres; 0: not the subject, or dropped
    std::vector<float> raw;   ///< (pixels) the same before it was smoothed
    std::vector<float> smoothed; ///< (pixels) and smoothed, with what smoothing takes off bends
    std::vector<Vec3f> normals;  ///< (pixels) unit, towards the camera; zero where not known
    std::vector<float> weight;   ///< (pixels) [0, 1]: how much a reading is worth
    std::vector<Rgba8> colors;   ///< (pixels) sRGB, or empty
    std::vector<Beyond> beyond;  ///< (pixels)
    std::vector<float> behind;   ///< (pixels) depth of the scene where `beyond` says scene, metres
    /// Pixels of the picture left of, above, right of and below the window: none shows the subject.
    std::array<int, 4> around{};

    [[nodiscard]] Vec3f point(int x, int y) const {
        return depth[camera.at(x, y)] * camera.ray(static_cast<float>(x), static_cast<float>(y));
    }
};

} // namespace toile::scan
