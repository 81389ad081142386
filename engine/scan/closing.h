// From a volume with gaps to one closed surface, and its colours.
#pragma once

#include "geometry/mesh.h"
#include "geometry/nearest_surface.h"
#include "geometry/slice.h"
#include "scan/volume.h"

#include <optional>
#include <span>

namespace toile::scan {

/// How each view sees the neighbourhood of a place.
class ViewPlaces {
  public:
    virtual ~ViewPlaces() = default;
    /// (views) camera from scan around `place`; `space` may hold them. [any thread]
    [[nodiscard]] virtual std::span<const Warp> at(const Vec3f& place,
                                                   std::vector<Warp>& space) const = 0;
};

/// A subject that kept still in itself: the same everywhere.
class RigidPlaces : public ViewPlaces {
  public:
    explicit RigidPlaces(std::span<const Pose> scan_from_camera);
    [[nodiscard]] std::span<const Warp> at(const Vec3f&, std::vector<Warp>&) const override {
        return camera_from_scan_;
    }

  private:
    std::vector<Warp> camera_from_scan_;
};

struct ClosedSurface {
    geometry::TriangleMesh mesh; ///< closed, manifold, one piece, with normals
    std::size_t dropped_pieces = 0;
    double guessed_share = 0.0; ///< of the vertices: no reading near
};

/// The zero set of the volume. What no reading tells is inside where no view looked through it and
/// outside elsewhere, with a smooth surface in between (volumetric diffusion, Davis et al. 2002); a
/// floor (scan's coordinates, normal up) closes what stands on it. `likely`: a closed surface that
/// nearly is the subject's own, or null; where no reading tells, it does. \throw Error when nothing
/// is left
[[nodiscard]] ClosedSurface
closed_surface(const Volume& volume, std::span<const DepthView* const> views,
               const ViewPlaces& places, const std::optional<geometry::Plane>& floor,
               const geometry::NearestSurface* likely, const RowLoop& rows);

/// Moves a surface and its normals.
void move(const Eigen::Isometry3d& by, geometry::TriangleMesh& mesh);

/// One round of smoothing that keeps the volume (Taubin 1995), normals made anew.
void smooth(geometry::TriangleMesh& mesh);

/// (nv) mean colour of each vertex over the views that see it, best those that look at it straight;
/// what none sees takes its neighbours' colours. Empty when no view has colours.
[[nodiscard]] std::vector<Rgba8> vertex_colors(const geometry::TriangleMesh& mesh,
                                               std::span<const DepthView* const> views,
                                               const ViewPlaces& places, const RowLoop& rows);

} // namespace toile::scan
