// When a mirror that ended is started again, and when it is kept simple.
#pragma once

#include <cstdint>
#include <deque>

namespace toile::apps::kiosk {

struct RestartOptions {
    std::uint32_t stock = 2;   ///< so many: only plugins that came with the program
    std::uint32_t crashes = 3; ///< so many ...
    double within_s = 120.0;   ///< ... in this time: safe mode
    double pause_s = 0.2;      ///< before the first start again; doubled each time
    double longest_pause_s = 2.0;
    double safe_s =
        600.0; ///< so long without a crash in safe mode: the whole mirror is tried again
};

/// Pure: times come from outside, seconds of any clock that only goes forward.
class RestartPolicy {
  public:
    explicit RestartPolicy(const RestartOptions& options = {}) : options_(options) {}

    struct Decision {
        double pause_s = 0.0;
        bool stock = false; ///< stock plugins only: another one may be at fault
        bool safe = false;  ///< the same, and a plain screen
    };
    /// The mirror crashed or stalled.
    Decision crashed(double now_s);
    /// Is it time to try everything again?
    [[nodiscard]] bool recovered(double now_s) const;
    void leave_safe_mode();

    [[nodiscard]] std::uint64_t restarts() const { return restarts_; }
    [[nodiscard]] bool stock() const { return stock_; }
    [[nodiscard]] bool safe() const { return safe_; }

  private:
    RestartOptions options_;
    std::deque<double> times_; ///< of the last crashes
    std::uint64_t restarts_ = 0;
    bool stock_ = false;
    bool safe_ = false;
};

} // namespace toile::apps::kiosk
