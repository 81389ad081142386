// Eases arms out of the trunk, head and thighs by turning them at shoulder and elbow.
#pragma once

#include "body/body_volumes.h"

namespace toile::body {

struct ClearanceOptions {
    int iterations = 10;
    float margin = 0.004f;            ///< metres kept between arm and body
    float upper_arm_overlap = 0.012f; ///< flesh at the armpit may touch
};

/// Turns the arms of `world` (rotations and positions of both arms' joints, bone lengths hold)
/// until samples along upper arm, forearm and hand are outside of the other parts. A continuous
/// function of its input, so that smooth motion stays smooth. Deepest sample left over, metres.
float clear_arms(const BodyVolumes& volumes, const Skeleton& skeleton, JointTransforms& world,
                 const ClearanceOptions& options = {}) noexcept;

} // namespace toile::body
