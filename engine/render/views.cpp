#include "render/views.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace toile::render {
namespace {

struct Known {
    const char* name;
    float azimuth_deg;
    float height_deg;
};
constexpr std::array kViews = {
    Known{"front", 0.0f, 0.0f},
    Known{"back", 180.0f, 0.0f},
    Known{"left", 90.0f, 0.0f},
    Known{"right", -90.0f, 0.0f},
    Known{"three_quarter", -35.0f, 0.0f},
    Known{"three_quarter_left", 35.0f, 0.0f},
    Known{"three_quarter_back", 215.0f, 0.0f},
    Known{"above", -35.0f, 35.0f},
};

float radians(float degrees) {
    return degrees * std::numbers::pi_v<float> / 180.0f;
}

} // namespace

View view_from_name(std::string_view name) {
    std::string known;
    for (const Known& v : kViews) {
        if (name == v.name) return {v.name, v.azimuth_deg, v.height_deg};
        known += known.empty() ? v.name : std::string(", ") + v.name;
    }
    throw UsageError("unknown view '" + std::string(name) + "'; there are " + known);
}

std::vector<View> views_from_names(std::string_view names) {
    std::vector<View> views;
    while (true) {
        const std::size_t comma = names.find(',');
        views.push_back(view_from_name(names.substr(0, comma)));
        if (comma == std::string_view::npos) return views;
        names.remove_prefix(comma + 1);
    }
}

Camera frame_view(const View& view, const Vec3f& low, const Vec3f& high, int width, int height,
                  const Framing& framing) {
    const Vec3f centre = 0.5f * (low + high);
    const Quatf turn = Quatf(Eigen::AngleAxisf(radians(view.azimuth_deg), Vec3f::UnitY())) *
                       Quatf(Eigen::AngleAxisf(-radians(view.height_deg), Vec3f::UnitX()));
    const float half_long = 18.0f / framing.lens_mm;
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    const float half_x = half_long * std::min(1.0f, w / h);
    const float half_y = half_long * std::min(1.0f, h / w);

    // The nearest distance at which every corner of the box stays inside the margins.
    const float inside = 1.0f - 2.0f * framing.margin;
    float distance = 0.1f;
    for (int i = 0; i < 8; ++i) {
        const Vec3f corner((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                           (i & 4) != 0 ? high.z() : low.z());
        const Vec3f p = turn.conjugate() * (corner - centre);
        distance = std::max({distance, p.z() + std::abs(p.x()) / (half_x * inside),
                             p.z() + std::abs(p.y()) / (half_y * inside)});
    }
    Camera camera;
    camera.world_from_camera.rotation = turn;
    camera.world_from_camera.translation = centre + turn * Vec3f(0.0f, 0.0f, distance);
    camera.left = -half_x;
    camera.right = half_x;
    camera.bottom = -half_y;
    camera.top = half_y;
    return camera;
}

Lighting studio_lighting(const Camera& camera) {
    Lighting lighting;
    const Vec3f back = camera.world_from_camera.rotation * Vec3f::UnitZ();
    const float azimuth = std::atan2(back.x(), back.z());
    const Eigen::AngleAxisf turn(azimuth, Vec3f::UnitY());
    lighting.key_direction = turn * lighting.key_direction;
    lighting.fill_direction = turn * lighting.fill_direction;
    lighting.rim_direction = turn * lighting.rim_direction;
    return lighting;
}

void bounds(std::span<const Vec3f> points, Vec3f& low, Vec3f& high) {
    if (points.empty()) throw Error("nothing to frame: there are no points");
    low = high = points[0];
    for (const Vec3f& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
}

} // namespace toile::render
