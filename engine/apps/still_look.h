// A dressed person who takes up a pose and stays in it until the clothes hang.
#pragma once

#include "apps/fitting_room.h"
#include "body/body_volumes.h"
#include "pipeline/run_report.h"
#include "pipeline/try_on_run.h"

#include <string>

namespace toile::apps {

inline constexpr double kFramesPerSecond = 30.0; ///< of pictures without a recording's own times

/// "" or "rest": the rest pose; FILE: its first pose; FILE@SECONDS: the pose at that time of a
/// motion. \throw Error naming the file, UsageError for a time outside of the motion
[[nodiscard]] body::Pose pose_from(const std::string& text, const body::Skeleton& skeleton,
                                   const body::BodyVolumes& volumes);

/// Moves into the pose within a second and stays for two more. Ends early when interrupted.
/// \throw Error
pipeline::RunReport leave_to_hang(FittingRoom& room, const body::Pose& pose,
                                  const pipeline::RunOptions& options);

} // namespace toile::apps
