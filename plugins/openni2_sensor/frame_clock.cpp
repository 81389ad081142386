#include "openni2_sensor/frame_clock.h"

#include <algorithm>

namespace toile::openni2_sensor {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kLargeStep = 2 * kSecond; // that must be borne out by something else
constexpr std::int64_t kLate = kSecond;          // frames that are older begin a new count

/// Neither is more than twice the other.
bool agree(std::int64_t a, std::int64_t b) {
    return a <= 2 * b && b <= 2 * a;
}

} // namespace

FrameClock::Step FrameClock::believed(Step told, std::optional<std::int64_t> waited_ns) const {
    Step out = told;
    out.numbers = std::max<std::int64_t>(1, told.numbers); // a count that begins anew: the next one
    const bool agreed = agree(out.numbers * period_ns_, told.time_ns);
    const bool waited = !waited_ns || told.time_ns <= *waited_ns + kLargeStep;
    if (out.numbers * period_ns_ > kLargeStep && !(agreed && waited)) {
        const bool usual = told.time_ns > 0 && told.time_ns <= kLargeStep;
        out.numbers = usual ? std::max<std::int64_t>(1, told.time_ns / period_ns_) : 1;
    }
    const bool ahead = told.time_ns > kLargeStep && !(waited_ns ? waited : agreed);
    if (ahead || told.time_ns <= 0) out.time_ns = out.numbers * period_ns_;
    return out;
}

FrameClock::Verdict FrameClock::take(const FrameStamp& device,
                                     std::optional<std::int64_t> waited_ns) {
    const Step told{std::int64_t{device.number} - std::int64_t{device_.number},
                    device.time_ns - device_.time_ns};
    Step step;
    jump_ns_ = 0;
    if (any_ && away_ns_) {
        step.time_ns = std::max(period_ns_, *away_ns_);
        step.numbers = step.time_ns / period_ns_;
    } else if (any_) {
        const bool recent = told.time_ns >= -kLate;
        if (told.numbers == 0 && recent && 2 * told.time_ns <= period_ns_) return Verdict::repeated;
        if (told.numbers < 0 && -told.numbers * period_ns_ <= kLate && recent && told.time_ns <= 0)
            return Verdict::late;
        step = believed(told, waited_ns);
        if (told.time_ns < 0 || step.time_ns < told.time_ns) jump_ns_ = told.time_ns;
    }
    stamp_.number += static_cast<std::uint32_t>(step.numbers);
    stamp_.time_ns += step.time_ns;
    any_ = true;
    away_ns_.reset();
    device_ = device;
    return Verdict::next;
}

} // namespace toile::openni2_sensor
