// A chest that rises and falls.
#pragma once

#include "body/body_model.h"

#include <span>
#include <vector>

namespace toile::simulated_sensor {

/// Lowest at time 0, four seconds a breath.
class Breath {
  public:
    Breath() = default;
    /// `most_m`: how far the chest rises; 0: not. `parts` (nv) of the surface at rest.
    Breath(double most_m, const geometry::TriangleMesh& rest, std::span<const body::Part> parts,
           const body::Skeleton& skeleton);

    /// Moves posed positions (nv) along their normals.
    void move(double time_s, std::span<const Triangle> triangles, std::span<Vec3f> positions);

  private:
    void soften(const geometry::TriangleMesh& rest);

    float most_m_ = 0.0f;
    std::vector<float> weights_; ///< (nv), or empty
    std::vector<Vec3f> normals_;
};

} // namespace toile::simulated_sensor
