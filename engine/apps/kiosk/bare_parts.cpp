#include "apps/kiosk/bare_parts.h"

#include "apps/kiosk/hiding_depth.h"
#include "geometry/nearest_surface.h"

namespace toile::apps::kiosk {
namespace {

constexpr float kNear_m = 0.02f;    // of cloth: the seam between cloth and skin stays the cloth's
constexpr float kBeneath_m = 0.10f; // along the normal

} // namespace

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
        if (!is_arm(model.parts[v])) continue;
        const Vec3f& p = model.rest.positions[v];
        const bool covered =
            nearest.nearest(p, kNear_m).triangle != geometry::kNoTriangle ||
            nearest.blocked(p - kNear_m * normals[v], normals[v], 0.0f, kNear_m + kBeneath_m);
        if (!covered) out.push_back(v);
    }
    return out;
}

} // namespace toile::apps::kiosk
