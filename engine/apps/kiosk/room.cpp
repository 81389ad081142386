#include "apps/kiosk/room.h"

#include "geometry/floor_plane.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace toile::apps::kiosk {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr int kEvery = 6;            // pixels
constexpr std::size_t kFewest = 500; // points
constexpr float kReach_m = 0.02f;    // of the floor's own points
constexpr float kMostTilt = 60.0f;

} // namespace

Eigen::Isometry3d camera_place(const CameraSettings& settings) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.translate(Vec3d(0.0, settings.height_m, 0.0));
    out.rotate(Eigen::AngleAxisd(settings.tilt_deg * kRadian, Vec3d::UnitX()));
    return out;
}

std::optional<CameraSettings> find_camera(const imaging::DepthImage& depth,
                                          const imaging::Intrinsics& camera) {
    std::vector<Vec3f> points;
    for (int y = 0; y < depth.height; y += kEvery)
        for (int x = 0; x < depth.width; x += kEvery) {
            const float z = depth.metres[static_cast<std::size_t>(y) * depth.width + x];
            if (!(z > 0.3f)) continue;
            if (const auto p = imaging::unproject(camera, {x, y}, z))
                points.push_back(p->cast<float>());
        }
    if (points.size() < kFewest) return std::nullopt;
    const auto found =
        geometry::find_floor(points, Vec3f::UnitY(), kMostTilt * static_cast<float>(kRadian));
    if (!found) return std::nullopt;
    const geometry::Plane plane = geometry::refined_plane(*found, points, kReach_m);
    const Vec3f up = plane.normal.normalized();
    CameraSettings out;
    out.height_m =
        std::abs(static_cast<double>(plane.offset) / static_cast<double>(plane.normal.norm()));
    out.tilt_deg = std::atan2(static_cast<double>(-up.z()), static_cast<double>(up.y())) / kRadian;
    return out;
}

LightVerdict judge_light(float level, float clipped) {
    constexpr float kDark = 0.12f;
    constexpr float kMostClipped = 0.08f;
    if (level < kDark) return LightVerdict::dark;
    return clipped > kMostClipped ? LightVerdict::bright : LightVerdict::good;
}

} // namespace toile::apps::kiosk
