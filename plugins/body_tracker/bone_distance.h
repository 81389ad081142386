// How far a point is from somebody's bones: whose cells are whose.
#pragma once

#include "body/skeleton.h"

#include <array>

namespace toile::body_tracker {

/// Distance of a point from a person's bones, less their thickness, metres; camera frame.
class BoneDistance {
  public:
    void set(const body::JointTransforms& joints) noexcept;
    [[nodiscard]] float operator()(const Vec3f& point) const noexcept;

  private:
    struct Bone {
        Vec3f from = Vec3f::Zero(), along = Vec3f::Zero();
        float length = 0.0f, radius = 0.0f;
    };
    std::array<Bone, 20> bones_;
    std::size_t count_ = 0;
    Vec3f low_ = Vec3f::Zero(), high_ = Vec3f::Zero();
};

} // namespace toile::body_tracker
