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
    enum class Kind { invalid, act, picture, fault, quit };
    std::uint64_t frame = 0; ///< of the mirror, from 0
    Kind kind = Kind::invalid;
    Action action = Action::invalid;
    std::string name; ///< of a picture without its ending; of a fault
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
