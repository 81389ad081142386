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
    Kind kind = Kind::invalid;
    Action action = Action::invalid;
    std::uint32_t person = 1; ///< who acts: the first, or the second who is there
    std::string name;         ///< of a picture without its ending; of a fault
};

/// Faults that a script can inject: "camera", "picture", "disk", "crash", "stall".
struct Script {
    std::vector<ScriptStep> steps; ///< in the order of their frames

    /// Steps of one frame.
    [[nodiscard]] std::vector<ScriptStep> at(std::uint64_t frame) const;
};

/// JSON; docs/kiosk.md. \throw Error naming file and place
[[nodiscard]] Script load_script(const std::filesystem::path& file);

} // namespace toile::apps::kiosk
