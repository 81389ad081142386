#include "garment/skin_gap.h"

#include "core/error.h"

#include <cmath>

namespace toile::garment {

SkinGap::SkinGap(std::span<const Triangle> body_triangles, std::size_t body_vertices,
                 std::size_t cloth_vertices)
    : walk_(body_triangles, body_vertices), rows_(body_vertices, Vec4f::Zero()),
      gaps_(cloth_vertices, 0.0f), beneath_(cloth_vertices, 0) {}

void SkinGap::find(const SkinSurface& body, std::span<const Vec3f> cloth) {
    if (body.positions.size() != rows_.size() || body.normals.size() != rows_.size() ||
        cloth.size() != gaps_.size())
        throw Error("skin gap: " + std::to_string(body.positions.size()) + " body and " +
                    std::to_string(cloth.size()) + " garment vertices, " +
                    std::to_string(rows_.size()) + " and " + std::to_string(gaps_.size()) +
                    " wanted");
    const geometry::NearestSurface surface(body.positions, walk_.triangles());
    for (std::size_t v = 0; v < cloth.size(); ++v) {
        if (!cloth[v].allFinite())
            throw Error("skin gap: garment vertex " + std::to_string(v) + " is not finite");
        beneath_[v] = surface.nearest(cloth[v]).triangle;
    }
    follow(body, cloth);
}

void SkinGap::follow(const SkinSurface& body, std::span<const Vec3f> cloth) noexcept {
    for (std::size_t v = 0; v < rows_.size(); ++v)
        rows_[v] << body.positions[v], 0.0f;
    for (std::size_t v = 0; v < cloth.size(); ++v) {
        const Vec4f p(cloth[v].x(), cloth[v].y(), cloth[v].z(), 0.0f);
        const geometry::WalkPoint found = walk_.walk(rows_, p, beneath_[v]);
        if (found.triangle == geometry::kNoTriangle) continue; // not finite: the last gap stays
        beneath_[v] = found.triangle;
        const Triangle& t = walk_.triangles()[found.triangle];
        Vec3f out = Vec3f::Zero();
        for (std::size_t k = 0; k < 3; ++k)
            out += found.bary[k] * body.normals[t[k]];
        const float distance = std::sqrt(found.squared);
        gaps_[v] = (p - found.point).head<3>().dot(out) < 0.0f ? -distance : distance;
    }
}

} // namespace toile::garment
