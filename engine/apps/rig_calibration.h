// toile scan --calibrate: where several cameras stand to each other.
#pragma once

#include "apps/camera_set.h"
#include "apps/global_options.h"
#include "host/services.h"
#include "imaging/rig_file.h"

namespace toile::apps {

struct RigRequest {
    std::string method;       ///< "ball" or "person"
    double radius_m = 0.0;    ///< of the ball; 0: found out
    std::uint32_t frames = 0; ///< at most so many of each camera; 0: all
};

/// Reads the cameras to their end. The world is that of the first camera where it knows it, else
/// upright with the floor at 0 where one sees the floor, below the first camera and turned as it
/// is. \throw Error with what to do when the cameras cannot be placed
[[nodiscard]] imaging::RigFile calibrate_rig(CameraSet& cameras, const RigRequest& request,
                                             host::Registry& registry, host::Services& services,
                                             const toile_limits& limits);

} // namespace toile::apps
