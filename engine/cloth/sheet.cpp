#include "cloth/sheet.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::cloth {

float directional_stiffness(const Fabric& fabric, const Vec2f& unit) {
    const float c2 = unit.x() * unit.x();
    const float s2 = unit.y() * unit.y();
    return 1.0f /
           (c2 * c2 / fabric.stretch_weft + s2 * s2 / fabric.stretch_warp + s2 * c2 / fabric.shear);
}

float directional_rigidity(const Fabric& fabric, const Vec2f& unit) {
    return fabric.bend_warp * unit.x() * unit.x() + fabric.bend_weft * unit.y() * unit.y();
}

void check(const ClothMesh& mesh, const Fabric& fabric) {
    if (mesh.positions.empty() || mesh.triangles.empty()) {
        throw Error("garment mesh: has no vertices or no triangles; give a welded triangle mesh");
    }
    if (!mesh.corner_coords.empty() && mesh.corner_coords.size() != 3 * mesh.triangles.size()) {
        throw Error("garment mesh: " + std::to_string(mesh.corner_coords.size()) +
                    " material coordinates for " + std::to_string(mesh.triangles.size()) +
                    " triangles; give three per triangle");
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (!mesh.positions[i].allFinite()) {
            throw Error("garment mesh: vertex " + std::to_string(i) + " is not finite");
        }
    }
    for (std::size_t i = 0; i < mesh.corner_coords.size(); ++i) {
        if (!mesh.corner_coords[i].allFinite()) {
            throw Error("garment mesh: a material coordinate of triangle " + std::to_string(i / 3) +
                        " is not finite");
        }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : mesh.triangles[t]) {
            if (v >= mesh.positions.size()) {
                throw Error("garment mesh: triangle " + std::to_string(t) + " names vertex " +
                            std::to_string(v) + " of " + std::to_string(mesh.positions.size()));
            }
        }
    }
    for (const auto& seam : mesh.seams) {
        if (seam[0] >= mesh.positions.size() || seam[1] >= mesh.positions.size()) {
            throw Error("garment mesh: a seam names a vertex that does not exist");
        }
    }
    const auto positive = [](float value) { return std::isfinite(value) && value > 0.0f; };
    const auto not_negative = [](float value) { return std::isfinite(value) && value >= 0.0f; };
    if (!positive(fabric.density) || !positive(fabric.stretch_warp) ||
        !positive(fabric.stretch_weft) || !positive(fabric.shear)) {
        throw Error("fabric: density, stretch and shear must be greater than zero");
    }
    if (!not_negative(fabric.bend_warp) || !not_negative(fabric.bend_weft) ||
        !not_negative(fabric.friction) || !not_negative(fabric.damping) ||
        !not_negative(fabric.thickness)) {
        throw Error("fabric: thickness, bending, friction and damping must not be negative");
    }
}

void check_areas(const ClothMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<Vec2f, 3> corner = material_corners(mesh, t);
        const Vec2f u = corner[1] - corner[0];
        const Vec2f v = corner[2] - corner[0];
        if (!(std::abs(u.x() * v.y() - v.x() * u.y()) > 2e-10f)) {
            throw Error("garment mesh: triangle " + std::to_string(t) +
                        " has no area in its material coordinates");
        }
    }
}

std::array<Vec2f, 3> material_corners(const ClothMesh& mesh, std::size_t t) {
    if (!mesh.corner_coords.empty()) {
        return {mesh.corner_coords[3 * t], mesh.corner_coords[3 * t + 1],
                mesh.corner_coords[3 * t + 2]};
    }
    const Vec3f a = mesh.positions[mesh.triangles[t][0]];
    const Vec3f ab = mesh.positions[mesh.triangles[t][1]] - a;
    const Vec3f ac = mesh.positions[mesh.triangles[t][2]] - a;
    const Vec3f normal = ab.cross(ac).normalized();
    // Warp stands as upright as the triangle allows.
    Vec3f warp = Vec3f::UnitY() - normal * normal.y();
    if (warp.norm() < 1e-3f) {
        warp = Vec3f::UnitZ() - normal * normal.z();
    }
    warp.normalize();
    const Vec3f weft = warp.cross(normal);
    return {Vec2f(0.0f, 0.0f), Vec2f(ab.dot(weft), ab.dot(warp)),
            Vec2f(ac.dot(weft), ac.dot(warp))};
}

} // namespace toile::cloth
