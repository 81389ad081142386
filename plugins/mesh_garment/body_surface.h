// A body's rest surface as a garment sees it: nearest point, signed distance, weights there.
#pragma once

#include "body/body_model.h"
#include "geometry/nearest_surface.h"

#include <span>

namespace toile::mesh_garment {

/// Borrowed views of a body in its rest pose (or in the pose a garment was made on).
struct BodyView {
    std::span<const Vec3f> positions;                            ///< (nv) metres
    std::span<const Triangle> triangles;                         ///< (nf) counter-clockwise outside
    std::span<const std::array<std::uint16_t, 4>> joint_indices; ///< (nv)
    std::span<const std::array<float, 4>> joint_weights;         ///< (nv)
    std::array<Vec3f, body::kJointCount> joints;                 ///< rest positions
};

using geometry::SurfacePoint;

/// Built once per body; queries are const and allocate nothing.
class BodySurface {
  public:
    /// Borrows the view's arrays for its life.
    explicit BodySurface(const BodyView& body)
        : body_(body), nearest_(body.positions, body.triangles) {}

    [[nodiscard]] const BodyView& view() const { return body_; }
    /// Nearest point of the skin; its signed distance is negative inside.
    [[nodiscard]] SurfacePoint nearest(const Vec3f& point) const noexcept {
        return nearest_.nearest(point);
    }

  private:
    BodyView body_;
    geometry::NearestSurface nearest_;
};

} // namespace toile::mesh_garment
