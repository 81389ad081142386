// A dressed person who takes up a pose and stays in it until the clothes hang.
#pragma once

#include "apps/fitting_room.h"
#include "pipeline/run_report.h"
#include "pipeline/try_on_run.h"

#include <string>

namespace toile::apps {

inline constexpr double kFramesPerSecond = 30.0; ///< of pictures without a recording's own times

/// Moves into a pose within a second and stays for two more; ends early when interrupted. `pose`:
/// "" or "rest": the rest pose; FILE: its first pose; FILE@SECONDS: the pose at that time of a
/// motion. \throw Error naming the file, UsageError for a time outside of the motion
pipeline::RunReport leave_to_hang(FittingRoom& room, const std::string& pose,
                                  const pipeline::RunOptions& options);

} // namespace toile::apps
