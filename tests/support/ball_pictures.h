// Pictures of a ball that rolls past a wall: what the sample recordings of sensors show.
#pragma once

#include "imaging/camera.h"

#include <cmath>
#include <limits>

namespace toile::test {

inline constexpr double kBallRadius = 0.3, kBallDistance = 1.5, kWallDistance = 2.0; // metres

inline imaging::Intrinsics ball_camera(int width, int height) {
    imaging::Intrinsics out;
    out.width = width;
    out.height = height;
    out.fx = out.fy = 0.9 * width;
    out.cx = 0.5 * (width - 1);
    out.cy = 0.5 * (height - 1);
    return out;
}

/// Metres along the camera's axis of what a pixel shows: ball, wall, or 0 for neither; the right
/// edge has no reading.
inline double ball_depth(const imaging::Intrinsics& camera, int frame, int x, int y) {
    if (x == camera.width - 1) return 0.0;
    const Vec3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
    const Vec3d centre(-0.3 + 0.15 * frame, 0.1, kBallDistance);
    const double a = ray.squaredNorm();
    const double b = ray.dot(centre);
    const double c = centre.squaredNorm() - kBallRadius * kBallRadius;
    const double root = b * b - a * c;
    return root > 0.0 ? (b - std::sqrt(root)) / a : kWallDistance;
}

/// As cameras give it: whole millimetres, NaN without a reading.
inline imaging::DepthImage ball_depth_picture(const imaging::Intrinsics& camera, int frame) {
    imaging::DepthImage out{camera.width, camera.height, {}};
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const double mm = std::round(1000.0 * ball_depth(camera, frame, x, y));
            out.metres.push_back(mm > 0.0 ? static_cast<float>(0.001 * mm)
                                          : std::numeric_limits<float>::quiet_NaN());
        }
    return out;
}

inline imaging::Image ball_color_picture(const imaging::Intrinsics& camera, int frame) {
    imaging::Image out{camera.width, camera.height, {}};
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const bool ball = ball_depth(camera, frame, x, y) < kWallDistance;
            const auto bright = static_cast<std::uint8_t>(ball ? 200 : 90 + x);
            out.pixels.insert(out.pixels.end(),
                              {bright, static_cast<std::uint8_t>(ball ? 60 : 110), 80, 255});
        }
    return out;
}

} // namespace toile::test
