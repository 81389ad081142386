// Runs the frame calls of one plugin instance and decides when to go on without it.
#pragma once

#include "host/faults.h"
#include "host/instance.h"
#include "pipeline/stage_clock.h"

#include <string>

namespace toile::pipeline {

class FrameGuard {
  public:
    FrameGuard(host::Instance& instance, const toile_limits& limits)
        : instance_(instance),
          watch_({.live_clock = limits.live_clock != 0, .budget_s = limits.frame_budget_s}) {}

    /// work(toile_instance*) -> toile_status; finite() -> bool looks at what it wrote. False when
    /// the result must not be used: the caller falls back. [frame]
    template <class Work, class Finite>
    bool run(const Work& work, const Finite& finite) noexcept {
        if (!watch_.on()) return false;
        const double start = wall_seconds();
        const toile_status status = instance_.frame(work);
        const bool usable = status == TOILE_OK && finite();
        if (watch_.frame(status, status != TOILE_OK || usable, wall_seconds() - start))
            switched_off_ = true;
        return usable;
    }

    /// Empty while the plugin is in use, else why it was switched off. [main]
    [[nodiscard]] std::string fault() {
        if (!switched_off_) return {};
        if (text_.empty()) {
            text_ = watch_.text(instance_.id());
            const std::string reported = instance_.take_error();
            if (!reported.empty()) text_ += " (" + reported + ")";
        }
        return text_;
    }

  private:
    host::Instance& instance_;
    host::FaultWatch watch_;
    bool switched_off_ = false;
    std::string text_;
};

} // namespace toile::pipeline
