// When a plugin must be switched off while frames go on, and the checks that tell.
#pragma once

#include "abi/base.h"

#include <cstdint>
#include <span>
#include <string>

namespace toile::host {

/// No NaN and no infinity. [frame]
[[nodiscard]] bool all_finite(std::span<const float> values) noexcept;
/// The same for F32, F32X2, F32X3 and F32X4 views; a view of another format is finite. [frame]
[[nodiscard]] bool view_finite(const toile_view& view) noexcept;
[[nodiscard]] bool view_finite(const toile_view_mut& view) noexcept;

enum class Fault : std::uint8_t {
    none,        ///< in use
    non_finite,  ///< returned NaN or infinity: at once
    failing,     ///< frame calls fail again and again
    over_budget, ///< overruns its budget again and again (live clock only)
};

struct FaultLimits {
    bool live_clock = false; ///< lock-step never counts time
    double budget_s = 0.0;   ///< of one frame call
    int overruns = 24;       ///< of the last 32 frames
    int failures = 16;       ///< of the last 32 frames
};

/// Watches one instance. Once switched off it stays off until `clear`. No allocation. [frame]
class FaultWatch {
  public:
    explicit FaultWatch(FaultLimits limits = {}) noexcept : limits_(limits) {}

    /// Counts one frame call. Returns true when this call is the one that switches it off.
    bool frame(toile_status status, bool finite, double elapsed_s) noexcept;

    [[nodiscard]] bool on() const noexcept { return fault_ == Fault::none; }
    [[nodiscard]] Fault fault() const noexcept { return fault_; }
    [[nodiscard]] std::uint64_t overruns() const noexcept { return overruns_; }
    [[nodiscard]] std::uint64_t failures() const noexcept { return failures_; }
    /// After a new bind or reset: gives it another chance.
    void clear() noexcept;
    /// "acme.cloth is switched off: returned numbers that are not finite". [main]
    [[nodiscard]] std::string text(const std::string& plugin_id) const;

  private:
    FaultLimits limits_;
    Fault fault_ = Fault::none;
    std::uint32_t recent_overruns_ = 0; // one bit a frame, the newest lowest
    std::uint32_t recent_failures_ = 0;
    std::uint64_t overruns_ = 0;
    std::uint64_t failures_ = 0;
};

} // namespace toile::host
