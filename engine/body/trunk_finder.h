// Neck, shoulders, armpits, chest and waist of an unknown body that stands upright and faces +Z.
#pragma once

#include "body/leg_finder.h"

namespace toile::body {

struct FoundPoint {
    Vec3f point = Vec3f::Zero();
    double trust = 0.0; ///< [0, 1]
};

/// Of pairs the first is the left one, at larger x.
struct FoundTrunk {
    float neck = 0.0f; ///< height of the neck's thinnest level
    Vec3f neck_up = Vec3f::UnitY();
    FoundPoint brow, head_back, larynx, neck_back, neck_front, navel;
    std::array<FoundPoint, 2> neck_side, shoulder, armpit, scye_front, scye_back, bust_point,
        under_bust, lowest_rib, iliac_crest, iliac_spine, trochanter, gluteal_fold;
    std::array<bool, 2> has_arm{};
};

/// \throw Error naming what cannot be found
[[nodiscard]] FoundTrunk find_trunk(std::span<const Vec3f> positions,
                                    std::span<const Triangle> triangles, const Sections& sections,
                                    const FoundLegs& legs);

} // namespace toile::body
