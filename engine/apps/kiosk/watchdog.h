// A parent that starts the mirror, and starts it again when it crashes or stalls.
#pragma once

#include <string>
#include <vector>

namespace toile::apps::kiosk {

struct WatchdogOptions {
    double stall_s = 3.0;  ///< no sign of life for so long
    double start_s = 60.0; ///< the same before the first sign: plugins and garments are read
    double early_s = 15.0; ///< at least this in the first half minute: shaders are compiled
};

/// Runs `arguments` (program first) with --heartbeat FD, --restarts N and, after too many crashes,
/// --safe, until the mirror ends by itself or this process is interrupted. Its exit status.
/// \throw Error when it cannot be started
int watch(const std::vector<std::string>& arguments, const WatchdogOptions& options);

} // namespace toile::apps::kiosk
