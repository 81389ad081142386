// One body's surface and joints in the rest pose.
#pragma once

#include "body/skeleton.h"

#include <vector>

namespace toile::body {

/// On some template's topology; A pose, lowest vertex on y = 0, facing +Z; metres.
struct BodyShape {
    std::vector<Vec3f> positions; ///< (nv)
    Skeleton skeleton;
};

} // namespace toile::body
