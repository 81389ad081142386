// One arm of an unknown body: its triangles, elbow, wrist and fingertip.
#pragma once

#include "body/figure.h"
#include "body/trunk_finder.h"

namespace toile::body {

struct FoundArm {
    std::vector<Triangle> triangles; ///< beyond the plane through armpit and shoulder point
    Limb joints;
    FoundPoint elbow, radiale, wrist, inner_wrist, fingertip;
};

/// The body faces +Z; `left`: the arm at larger x.
/// \throw Error when nothing of an arm is found there
[[nodiscard]] FoundArm find_arm(std::span<const Vec3f> positions,
                                std::span<const Triangle> triangles, const FoundTrunk& trunk,
                                bool left);

} // namespace toile::body
