#include "apps/kiosk/restart_policy.h"

#include <algorithm>
#include <cmath>

namespace toile::apps::kiosk {

RestartPolicy::Decision RestartPolicy::crashed(double now_s) {
    ++restarts_;
    times_.push_back(now_s);
    while (times_.front() < now_s - options_.within_s)
        times_.pop_front();
    const auto recent = static_cast<std::uint32_t>(times_.size());
    stock_ = stock_ || recent >= options_.stock;
    safe_ = safe_ || recent >= options_.crashes;
    Decision out;
    out.stock = stock_;
    out.safe = safe_;
    out.pause_s = std::min(options_.longest_pause_s,
                           options_.pause_s * std::pow(2.0, static_cast<double>(recent) - 1.0));
    return out;
}

bool RestartPolicy::recovered(double now_s) const {
    return (safe_ || stock_) && !times_.empty() && now_s - times_.back() >= options_.safe_s;
}

void RestartPolicy::leave_safe_mode() {
    safe_ = stock_ = false;
    times_.clear();
}

} // namespace toile::apps::kiosk
