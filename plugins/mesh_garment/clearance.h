// Keeps a garment outside the body, with ease.
#pragma once

#include "mesh_garment/body_surface.h"

namespace toile::mesh_garment {

struct ClearanceReport {
    float least_m = 0.0f;          ///< least distance of a vertex, edge middle or triangle centre
    std::size_t short_of_ease = 0; ///< vertices and triangle centres nearer than the ease
    int rounds = 0;
};

/// Pushes vertices out until every vertex, edge middle and triangle centre is at least `ease`
/// metres outside the body. The garment gives way smoothly at first, then point by point. Where two
/// parts of the body are nearer to each other than twice the ease (between thighs) that cannot be
/// had everywhere; the report says so.
ClearanceReport clear_body(const BodySurface& body, std::span<const Triangle> triangles, float ease,
                           std::span<Vec3f> positions);

} // namespace toile::mesh_garment
