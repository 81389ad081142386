// Binds one size of a garment to a body and says each frame where its cloth would like to be.
#pragma once

#include "body/skinning.h"
#include "mesh_garment/clearance.h"
#include "mesh_garment/weight_transfer.h"

#include <functional>
#include <optional>

namespace toile::mesh_garment {

/// Borrowed views of a garment's simulation mesh.
struct GarmentView {
    std::span<const Vec3f> positions;    ///< (nv) on the body that it was made on
    std::span<const Triangle> triangles; ///< (nf)
    std::span<const std::array<std::uint16_t, 4>> joint_indices; ///< (nv), or empty: from the body
    std::span<const std::array<float, 4>> joint_weights;
    std::span<const float> pins; ///< (nv) 0 .. 1, or empty
    float ease_m = 0.004f;
};

struct Binding {
    std::vector<Vec3f> positions;  ///< (nv) on the new body in its rest pose
    body::SkinWeights skin;        ///< (nv)
    std::vector<float> attachment; ///< (nv) 0 free .. 1 follows its target exactly
    ClearanceReport clearance;
};

/// Called between the stages with the share done; may throw to stop.
using Progress = std::function<void(double fraction, const char* stage)>;

/// `made_on` null: the garment's positions are taken as made on `body`.
/// \throw Error when the body or the garment is unfit
[[nodiscard]] Binding bind(const BodySurface& body, const BodySurface* made_on,
                           const GarmentView& garment, const Progress& progress = {});

/// Targets by linear blend skinning. Built by bind's result, then allocation-free.
class Targets {
  public:
    Targets(const Binding& binding, const std::array<Vec3f, body::kJointCount>& rest_joints);

    [[nodiscard]] std::size_t vertex_count() const noexcept { return surface_.vertex_count(); }
    /// `world_from_joint`: rotations are the identity at rest. Writes (nv) rows.
    void evaluate(const body::JointTransforms& world_from_joint,
                  body::VectorRows positions) const noexcept;

  private:
    body::SkinnedSurface surface_;
    std::array<Vec3f, body::kJointCount> rest_joints_;
};

} // namespace toile::mesh_garment
