// A parent that starts the mirror, and starts it again when it crashes or stalls.
#pragma once

#include <string>
#include <vector>

namespace toile::apps::kiosk {

/// What the mirror writes to its watchdog.
enum class LifeSign : char {
    steady = '+',  ///< a frame is done, the next one comes soon
    patience = '~' ///< what comes next may take long: shaders are compiled, a display is made
};

struct WatchdogOptions {
    double stall_s = 1.5;     ///< no sign of life for so long after a steady one
    double start_s = 60.0;    ///< the same before the first sign: plugins and garments are read
    double patience_s = 15.0; ///< the same after a sign that asks for patience
};

/// Runs `arguments` (program first) with --heartbeat FD, --restarts N and, after too many crashes,
/// --stock or --safe, until the mirror ends by itself or this process is interrupted. Its exit
/// status. \throw Error when it cannot be started
int watch(const std::vector<std::string>& arguments, const WatchdogOptions& options);

} // namespace toile::apps::kiosk
