#include "apps/kiosk/bare_parts.h"

#include "geometry/nearest_surface.h"

#include <algorithm>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

constexpr float kNear_m = 0.02f;    // of cloth: the seam between cloth and skin stays the cloth's
constexpr float kBeneath_m = 0.10f; // along the normal
constexpr float kNearer_m = 0.06f;  // what is seen may lie so much before the tracked skin ...
constexpr float kFarther_m = 0.02f; // ... or behind it: farther is the trunk that a hand lies on
constexpr float kAround_m = 0.02f;
constexpr int kCell = 8;           // pixels
constexpr float kBefore_m = 0.01f; // a hand lies at least so much before the tracked trunk

bool may_be_bare(body::Part part) {
    using body::Part;
    return part == Part::left_lower_arm || part == Part::right_lower_arm ||
           part == Part::left_upper_arm || part == Part::right_upper_arm;
}

} // namespace

void TrunkDepth::fill(const pipeline::DressedPerson& person, const imaging::Intrinsics& camera,
                      const Eigen::Isometry3d& place, int width, int height) {
    columns_ = width / kCell + 1;
    cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(height / kCell + 1),
                  {});
    const Eigen::Isometry3d from_world = place.inverse();
    const Vec3f eye = place.translation().cast<float>();
    const auto& parts = person.body().model().parts;
    const auto& posed = person.posed();
    for (std::size_t v = 0; v < posed.positions.size(); ++v) {
        if (may_be_bare(parts[v]) || posed.normals[v].dot(eye - posed.positions[v]) <= 0.0f)
            continue;
        const Vec3d p = from_world * posed.positions[v].cast<double>();
        const auto pixel = imaging::project(camera, p);
        if (!pixel) continue;
        const auto x = static_cast<int>(std::lround(pixel->x()));
        const auto y = static_cast<int>(std::lround(pixel->y()));
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        Cell& cell = cells_[static_cast<std::size_t>(y / kCell * columns_ + x / kCell)];
        cell.sum -= static_cast<float>(p.z());
        ++cell.count;
    }
}

bool TrunkDepth::reaches(int x, int y, float metres) const {
    const Cell& cell = cells_[static_cast<std::size_t>(y / kCell * columns_ + x / kCell)];
    return cell.count > 0 && metres > cell.sum / static_cast<float>(cell.count) - kBefore_m;
}

std::vector<std::uint32_t> bare_vertices(const pipeline::DressedPerson& person) {
    const body::BodyModel& model = person.body().model();
    geometry::TriangleMesh cloth;
    for (const pipeline::WornGarment& garment : person.garments()) {
        const auto first = static_cast<std::uint32_t>(cloth.positions.size());
        cloth.positions.insert(cloth.positions.end(), garment.bound.begin(), garment.bound.end());
        for (const Triangle& t : garment.triangles())
            cloth.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    std::vector<Vec3f> normals(model.rest.positions.size());
    geometry::vertex_normals(model.rest.positions, model.rest.triangles, normals);
    std::vector<std::uint32_t> out;
    if (cloth.triangles.empty()) return out;
    const geometry::NearestSurface nearest(cloth.positions, cloth.triangles);
    for (std::uint32_t v = 0; v < model.rest.positions.size(); ++v) {
        if (!may_be_bare(model.parts[v])) continue;
        const Vec3f& p = model.rest.positions[v];
        const bool covered =
            nearest.nearest(p, kNear_m).triangle != geometry::kNoTriangle ||
            nearest.blocked(p - kNear_m * normals[v], normals[v], 0.0f, kNear_m + kBeneath_m);
        if (!covered) out.push_back(v);
    }
    return out;
}

void lift_bare_parts(const pipeline::DressedPerson& person,
                     const std::vector<std::uint32_t>& vertices, const imaging::Intrinsics& camera,
                     const Eigen::Isometry3d& place, const imaging::DepthImage& seen,
                     const TrunkDepth& trunk, float lift_m, int reach, imaging::DepthImage& out) {
    const Eigen::Isometry3d from_world = place.inverse();
    for (const std::uint32_t v : vertices) {
        const Vec3d p = from_world * person.posed().positions[v].cast<double>();
        const auto pixel = imaging::project(camera, p);
        const Vec3f to_eye = place.translation().cast<float>() - person.posed().positions[v];
        if (!pixel || person.posed().normals[v].dot(to_eye) <= 0.0f) continue;
        const auto x = static_cast<int>(std::lround(pixel->x()));
        const auto y = static_cast<int>(std::lround(pixel->y()));
        if (x < reach || y < reach || x >= seen.width - reach || y >= seen.height - reach) continue;
        const auto index = [&](int column, int row) {
            return static_cast<std::size_t>(row) * static_cast<std::size_t>(seen.width) +
                   static_cast<std::size_t>(column);
        };
        const float here = seen.metres[index(x, y)];
        const float farther = here + static_cast<float>(p.z());
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
