// Following a subject from picture to picture: what one camera's track and a rig's share.
#pragma once

#include "scan/registration.h"

#include <functional>

namespace toile::scan {

/// Of the field that is tracked against: coarse and wide.
inline constexpr VolumeOptions kTrackingVolume{.voxel_m = 0.01f, .truncation_m = 0.04f};

inline constexpr double kLeastOverlap = 0.5; ///< of what fits
inline constexpr double kMostRms_m = 0.015;

/// A motion so many times over, or a share of it.
[[nodiscard]] Pose times_over(const Pose& motion, double times);

/// From where the motion would go on (`step` after `last`), or else from where it was last; near
/// pairs first, since an arm's width away there may be another part of the subject.
/// `register_from(start, reach_m)` registers once.
[[nodiscard]] Registered
track_on(const Pose& last, const Pose& step,
         const std::function<Registered(const Pose& start, float reach_m)>& register_from);

} // namespace toile::scan
