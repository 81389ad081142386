// From a volume with gaps to one closed surface, and its colours.
#pragma once

#include "geometry/mesh.h"
#include "geometry/slice.h"
#include "scan/volume.h"

#include <optional>
#include <span>

namespace toile::scan {

struct ClosedSurface {
    geometry::TriangleMesh mesh; ///< closed, manifold, one piece, with normals
    std::size_t dropped_pieces = 0;
    double guessed_share = 0.0; ///< of the vertices: no reading near
};

/// The zero set of the volume. What no reading tells is inside where no view looked through it and
/// outside elsewhere, with a smooth surface in between (volumetric diffusion, Davis et al. 2002); a
/// floor (scan's coordinates, normal up) closes what stands on it. \throw Error when nothing is
/// left
[[nodiscard]] ClosedSurface closed_surface(const Volume& volume, std::span<const DepthView> views,
                                           std::span<const Pose> poses,
                                           const std::optional<geometry::Plane>& floor,
                                           const RowLoop& rows);

/// One round of smoothing that keeps the volume (Taubin 1995), normals made anew.
void smooth(geometry::TriangleMesh& mesh);

/// (nv) mean colour of each vertex over the views that see it, best those that look at it straight;
/// what none sees takes its neighbours' colours. Empty when no view has colours.
[[nodiscard]] std::vector<Rgba8> vertex_colors(const geometry::TriangleMesh& mesh,
                                               std::span<const DepthView> views,
                                               std::span<const Pose> poses, const RowLoop& rows);

} // namespace toile::scan
