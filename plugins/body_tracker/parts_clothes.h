// Cheap clothes and hair for training frames: the body's own surface, pushed out.
#pragma once

#include "body_tracker/parts_labels.h"
#include "core/random.h"

#include <span>
#include <vector>

namespace toile::body_tracker {

/// How a body is dressed in one frame; nothing of it when all is 0.
struct Outfit {
    float top_m = 0.0f;    ///< how far cloth stands off trunk and arms, at most
    float bottom_m = 0.0f; ///< the same of pelvis and legs
    bool long_sleeves = false, long_legs = false;
    float skirt_m = 0.0f;     ///< length below the hip joints; 0: none
    float skirt_flare = 0.0f; ///< how much wider each metre further down
    float hair_m = 0.0f;      ///< thickness on the skull
    bool long_hair = false;   ///< over neck and shoulders behind
    std::uint64_t folds = 0;  ///< seed of the smooth random field
};

[[nodiscard]] Outfit draw_outfit(Random& random);

/// Pushes the rest surface (nv) out along its normals (nv); labels (nv) say where cloth may be.
/// Cloth stands off by a smooth random share in [0, 1] of the outfit's distance. A skirt takes the
/// inner sides of the legs to the middle and the outer ones outwards. Parts stay those of the body
/// beneath.
void dress(const Outfit& outfit, const body::Skeleton& skeleton, std::span<const Vec3f> normals,
           std::span<const PartLabel> labels, std::span<Vec3f> positions);

} // namespace toile::body_tracker
