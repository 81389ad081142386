// Nearest points on a fixed triangle surface (Embree), for training on large surfaces.
#pragma once

#include "geometry/mesh.h"

#include <limits>
#include <memory>

namespace toile::geometry {

struct ProbeHit {
    std::uint32_t triangle = 0;
    Vec3f point = Vec3f::Zero();
    Vec3f barycentric = Vec3f::Zero(); ///< of `point`, in the order of the triangle's corners
    float distance = std::numeric_limits<float>::infinity();
};

/// Borrows the surface, which must outlive it and not change. Queries may run on any thread.
class SurfaceProbe {
  public:
    SurfaceProbe(std::span<const Vec3f> positions, std::span<const Triangle> triangles);
    ~SurfaceProbe();
    SurfaceProbe(const SurfaceProbe&) = delete;
    SurfaceProbe& operator=(const SurfaceProbe&) = delete;

    /// The nearest point within `limit` metres; distance infinity when there is none. Of equally
    /// near triangles the one with the lowest index.
    [[nodiscard]] ProbeHit nearest(const Vec3f& p,
                                   float limit = std::numeric_limits<float>::infinity()) const;
    [[nodiscard]] float distance(const Vec3f& p, float limit) const {
        return nearest(p, limit).distance;
    }

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace toile::geometry
