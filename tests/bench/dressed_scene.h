// The live per-frame path of one person in one garment, on fixed input: skinning, targets, cloth.
#pragma once

#include "body/body_model.h"
#include "body/motion.h"
#include "body/skinning.h"
#include "bullet_cloth/cloth_world.h"

#include <memory>

namespace toile::bench {

/// A garment made of the body's own surface, 15 mm out: trunk and upper arms, open at neck, hem
/// and sleeves. It stands for a shirt wherever no garment package is at hand.
struct Shirt {
    std::vector<Vec3f> positions;    ///< (nv) on the body at rest
    std::vector<Triangle> triangles; ///< (nf)
    body::SkinWeights skin;          ///< (nv)
};
[[nodiscard]] Shirt make_shirt(const body::BodyModel& model);

/// Allocates nothing after construction.
class DressedScene {
  public:
    DressedScene(const body::BodyModel& model, const bullet_cloth::Settings& settings = {});

    /// Poses the body and gives the shirt its targets.
    void pose(const body::JointTransforms& world) noexcept;
    /// Steps the cloth from the last pose to this one. \return false when the step was refused
    bool step_cloth(double dt_s, bool reset) noexcept;

    [[nodiscard]] const Shirt& shirt() const { return shirt_; }
    [[nodiscard]] std::span<const Vec3f> body_positions() const { return after_; }
    [[nodiscard]] std::span<const Vec3f> shirt_positions() const { return positions_; }

  private:
    const body::BodyModel& model_;
    Shirt shirt_;
    body::SkinnedSurface body_surface_, shirt_surface_;
    bullet_cloth::ClothWorld world_;
    std::uint32_t handle_ = 0;
    std::vector<Vec3f> before_, after_, normals_, targets_, positions_, shirt_normals_;
};

} // namespace toile::bench
