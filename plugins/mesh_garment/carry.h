// Moves a garment from the body it was made on to another one.
#pragma once

#include "mesh_garment/body_surface.h"

namespace toile::mesh_garment {

/// Bodies of one template (equal triangles): every garment vertex moves as the skin nearest to it
/// does, the field of displacements smoothed so that ease and details stay. Other bodies: the bones
/// of one are laid onto those of the other, by the garment's weights on the body it was made on.
/// positions (nv) on `from`; returns (nv) on `to`, not yet clear of it.
/// \throw Error when a system cannot be solved
[[nodiscard]] std::vector<Vec3f> carry(const BodySurface& from, const BodySurface& to,
                                       std::span<const Vec3f> positions,
                                       std::span<const Triangle> triangles);

} // namespace toile::mesh_garment
