#include "apps/kiosk/hiding_depth.h"

#include <algorithm>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

constexpr float kNearer_m = 0.06f;  // what is seen may lie so much before the tracked skin ...
constexpr float kFarther_m = 0.02f; // ... or behind it: farther is the trunk that a hand lies on
constexpr float kAround_m = 0.02f;
constexpr int kCell = 8;           // pixels
constexpr float kBefore_m = 0.01f; // a hand lies at least so much before the tracked trunk

} // namespace

std::optional<SeenPixel> seen_pixel(const imaging::Intrinsics& camera,
                                    const Eigen::Isometry3d& from_world, const Vec3f& at, int width,
                                    int height, int border) {
    const Vec3d p = from_world * at.cast<double>();
    const auto pixel = imaging::project(camera, p);
    if (!pixel) return std::nullopt;
    const SeenPixel out{static_cast<int>(std::lround(pixel->x())),
                        static_cast<int>(std::lround(pixel->y())), -static_cast<float>(p.z())};
    const bool inside =
        out.x >= border && out.y >= border && out.x < width - border && out.y < height - border;
    return inside ? std::optional(out) : std::nullopt;
}

bool is_arm(body::Part part) {
    using body::Part;
    return part == Part::left_lower_arm || part == Part::right_lower_arm ||
           part == Part::left_upper_arm || part == Part::right_upper_arm;
}

void TrunkDepth::fill(const TrackedSkin& skin, const imaging::Intrinsics& camera,
                      const Eigen::Isometry3d& place, int width, int height) {
    columns_ = width / kCell + 1;
    cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(height / kCell + 1),
                  {});
    const Eigen::Isometry3d from_world = place.inverse();
    const Vec3f eye = place.translation().cast<float>();
    for (std::size_t v = 0; v < skin.positions.size(); ++v) {
        if (is_arm(skin.parts[v]) || skin.normals[v].dot(eye - skin.positions[v]) <= 0.0f) continue;
        const auto seen = seen_pixel(camera, from_world, skin.positions[v], width, height);
        if (!seen) continue;
        Cell& cell = cells_[static_cast<std::size_t>(seen->y / kCell * columns_ + seen->x / kCell)];
        cell.sum += seen->metres;
        ++cell.count;
    }
}

bool TrunkDepth::reaches(int x, int y, float metres) const {
    const Cell& cell = cells_[static_cast<std::size_t>(y / kCell * columns_ + x / kCell)];
    return cell.count > 0 && metres > cell.sum / static_cast<float>(cell.count) - kBefore_m;
}

void lift_bare_parts(const TrackedSkin& skin, const std::vector<std::uint32_t>& vertices,
                     const imaging::Intrinsics& camera, const Eigen::Isometry3d& place,
                     const imaging::DepthImage& seen, const TrunkDepth& trunk, float lift_m,
                     int reach, imaging::DepthImage& out) {
    const Eigen::Isometry3d from_world = place.inverse();
    for (const std::uint32_t v : vertices) {
        const Vec3f to_eye = place.translation().cast<float>() - skin.positions[v];
        if (skin.normals[v].dot(to_eye) <= 0.0f) continue;
        const auto pixel =
            seen_pixel(camera, from_world, skin.positions[v], seen.width, seen.height, reach);
        if (!pixel) continue;
        const auto [x, y, tracked_m] = *pixel;
        const auto index = [&](int column, int row) {
            return static_cast<std::size_t>(row) * static_cast<std::size_t>(seen.width) +
                   static_cast<std::size_t>(column);
        };
        const float here = seen.metres[index(x, y)];
        const float farther = here - tracked_m;
        if (!(farther > -kNearer_m && farther < kFarther_m)) continue;
        for (int row = y - reach; row <= y + reach; ++row)
            for (int column = x - reach; column <= x + reach; ++column) {
                const std::size_t i = index(column, row);
                if (std::abs(seen.metres[i] - here) < kAround_m &&
                    !trunk.reaches(column, row, seen.metres[i]))
                    out.metres[i] = seen.metres[i] - lift_m;
            }
    }
}

} // namespace toile::apps::kiosk
