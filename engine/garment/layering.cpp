#include "garment/layering.h"

#include "geometry/nearest_surface.h"

#include <algorithm>

namespace toile::garment {
namespace {

constexpr float kReach_m = 0.12f;       // farther garments are not one above the other
constexpr float kBorderFull_m = 0.015f; // beside the inner garment's border the push fades out
constexpr float kBorderNone_m = 0.06f;
constexpr float kSlide_m = 0.05f; // pairs that slid this far apart no longer tell anything
constexpr float kMostPush_m = 0.10f;

} // namespace

LayerOffset::LayerOffset(std::span<const Vec3f> inner, std::span<const Triangle> inner_triangles,
                         std::span<const Vec3f> outer) {
    const geometry::NearestSurface surface(inner, inner_triangles);
    for (std::uint32_t i = 0; i < outer.size(); ++i) {
        const geometry::SurfacePoint found = surface.nearest(outer[i], kReach_m);
        if (found.triangle == geometry::kNoTriangle) continue;
        const Vec3f away = outer[i] - found.point;
        const Vec3f beside = away - away.dot(found.normal) * found.normal;
        const float weight = std::clamp(
            (kBorderNone_m - beside.norm()) / (kBorderNone_m - kBorderFull_m), 0.0f, 1.0f);
        if (weight == 0.0f) continue;
        pairs_.push_back(
            {i, inner_triangles[found.triangle], found.barycentric, beside.norm(), weight});
    }
}

void LayerOffset::apply(std::span<const Vec3f> inner, std::span<const Vec3f> inner_normals,
                        float gap_m, std::span<Vec3f> outer) const noexcept {
    for (const Pair& pair : pairs_) {
        Vec3f point = Vec3f::Zero();
        Vec3f normal = Vec3f::Zero();
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = pair.corners[static_cast<std::size_t>(k)];
            point += pair.barycentric[k] * inner[corner];
            normal += pair.barycentric[k] * inner_normals[corner];
        }
        const float length = normal.norm();
        if (length < 1e-6f) continue;
        normal /= length;
        Vec3f& vertex = outer[pair.outer];
        const Vec3f away = vertex - point;
        const float height = away.dot(normal);
        const float slid = (away - height * normal).norm();
        const float trust =
            pair.weight * std::clamp(2.0f - (slid - pair.beside_m) / kSlide_m, 0.0f, 1.0f);
        vertex += trust * std::clamp(gap_m - height, 0.0f, kMostPush_m) * normal;
    }
}

} // namespace toile::garment
