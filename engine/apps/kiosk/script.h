// A visit written down: what is pressed at which frame, for runs without a shopper.
#pragma once

#include "apps/kiosk/metrics.h"
#include "apps/kiosk/screens.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace toile::apps::kiosk {

struct ScriptStep {
    /// mask: white where cloth covers the camera picture, of the camera's size.
    enum class Kind { invalid, act, picture, mask, fault, quit };
    std::uint64_t frame = 0; ///< of the mirror, from 0
    double every_s = 0.0;    ///< then again and again after so many seconds; 0: once
    Kind kind = Kind::invalid;
    Action action = Action::invalid;
    std::uint32_t person = 1; ///< who acts: the first, or the second who is there
    std::string name;         ///< of a picture without its ending; of a fault
};

/// Faults that a script can inject: "camera", "clock", "picture", "disk", "crash", "stall".
struct Script {
    std::vector<ScriptStep> steps; ///< in the order of their frames

    /// Steps of one frame; those that come again, too.
    [[nodiscard]] std::vector<ScriptStep> at(std::uint64_t frame) const;
    /// Steps that come again between two moments, once for each time; seconds of any clock.
    /// `began_s` (steps): when each was first due, below 0 when it was not yet.
    [[nodiscard]] std::vector<ScriptStep> between(const std::vector<double>& began_s,
                                                  double before_s, double now_s) const;
};

/// JSON; docs/kiosk.md. \throw Error naming file and place
[[nodiscard]] Script load_script(const std::filesystem::path& file);

} // namespace toile::apps::kiosk
