// Simulated depth cameras in a room of 8 m.
#pragma once

#include "people.h"

namespace toile::scape_fit {

inline constexpr int kWidth = 180, kHeight = 240;

/// A camera at `place` that looks at the middle of the room, `down` radians below level.
inline FitCamera camera_at(const Vec3f& place, float down = 0.0f) {
    FitCamera out;
    out.intrinsics.width = kWidth;
    out.intrinsics.height = kHeight;
    out.intrinsics.fx = out.intrinsics.fy = 200.0;
    out.intrinsics.cx = 0.5 * (kWidth - 1);
    out.intrinsics.cy = 0.5 * (kHeight - 1);
    const Vec3f back = Vec3f(place.x(), 0.0f, place.z()).normalized();
    Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
    pose.linear().col(0) = Vec3f::UnitY().cross(back);
    pose.linear().col(1) = Vec3f::UnitY();
    pose.linear().col(2) = back;
    pose.linear() = pose.linear() * body::about(Vec3f::UnitX(), -down).toRotationMatrix();
    pose.translation() = place;
    out.world_from_camera = pose.cast<double>();
    return out;
}

/// Exact depths of a scene; the floor gives no reading when it is too shiny.
inline imaging::DepthImage depth_of(const FitCamera& camera, const geometry::TriangleMesh* person,
                                    bool shiny_floor = false) {
    geometry::TriangleMesh scene = test::box(Vec3f(-4.0f, 0.0f, -4.0f), Vec3f(4.0f, 3.0f, 4.0f));
    if (person != nullptr) add(scene, *person);
    const geometry::NearestSurface surface(scene.positions, scene.triangles);
    imaging::DepthImage out;
    out.width = kWidth;
    out.height = kHeight;
    const Eigen::Isometry3f place = camera.world_from_camera->cast<float>();
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto ray = imaging::unproject(camera.intrinsics, Eigen::Vector2d(x, y), 1.0);
            const Vec3f along = place.linear() * ray->cast<float>();
            const auto hit = surface.first_hit(place.translation(), along);
            const bool reads =
                hit && !(shiny_floor && (place * (hit->distance * ray->cast<float>())).y() < 0.01f);
            out.metres.push_back(reads ? hit->distance : std::nanf(""));
        }
    return out;
}

/// The same camera's colours: skin, cloth where `cloth` (one for each vertex of the person) says
/// so, walls of grey.
inline imaging::Image color_of(const FitCamera& camera, const geometry::TriangleMesh& person,
                               std::span<const std::uint8_t> cloth) {
    constexpr std::array<std::uint8_t, 4> kSkin{205, 152, 122, 255}, kCloth{70, 90, 150, 255},
        kWall{170, 170, 170, 255};
    const geometry::NearestSurface surface(person.positions, person.triangles);
    imaging::Image out;
    out.width = kWidth;
    out.height = kHeight;
    const Eigen::Isometry3f place = camera.world_from_camera->cast<float>();
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto ray = imaging::unproject(camera.intrinsics, Eigen::Vector2d(x, y), 1.0);
            const auto hit =
                surface.first_hit(place.translation(), place.linear() * ray->cast<float>());
            const bool covered = hit && cloth[person.triangles[hit->triangle][0]] != 0;
            const auto& color = hit ? (covered ? kCloth : kSkin) : kWall;
            out.pixels.insert(out.pixels.end(), color.begin(), color.end());
        }
    return out;
}

} // namespace toile::scape_fit
