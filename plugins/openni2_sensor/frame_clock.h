// Numbers and times of a stream that always rise, whatever its device says.
#pragma once

#include <cstdint>
#include <optional>

namespace toile::openni2_sensor {

struct FrameStamp {
    std::uint32_t number = 0;
    std::int64_t time_ns = 0;
};

/// Turns a device's count and clock into the stream's: both begin at 0. Steps are the device's own
/// as long as they can be believed: one of more than 2 s when a camera was waited for that long, or
/// when a recording's numbers and times agree within a factor of two. Else, and when the clock
/// stands still or goes back, a number counts as one period. Allocates nothing.
class FrameClock {
  public:
    explicit FrameClock(double period_s) : period_ns_(static_cast<std::int64_t>(1e9 * period_s)) {}

    /// `next`: takes its place in the stream. `repeated`: came before, leave it out. `late`: older
    /// than the frame before by no more than a second; leave it out.
    enum class Verdict : std::uint8_t { invalid, next, repeated, late };
    /// `waited_ns`: by the host's clock since the frame before; nothing for recordings.
    Verdict take(const FrameStamp& device, std::optional<std::int64_t> waited_ns);

    /// The device was away for so long; its next frame begins a new count.
    void resume(std::int64_t away_ns) noexcept { away_ns_ = away_ns; }

    /// Of the last frame taken, in the stream.
    [[nodiscard]] const FrameStamp& stamp() const noexcept { return stamp_; }
    /// By how much the device's clock went ahead or back at the last frame taken, when that was not
    /// believed; else 0.
    [[nodiscard]] std::int64_t jump_ns() const noexcept { return jump_ns_; }

  private:
    struct Step {
        std::int64_t numbers = 0, time_ns = 0;
    };
    [[nodiscard]] Step believed(Step told, std::optional<std::int64_t> waited_ns) const;

    std::int64_t period_ns_;
    bool any_ = false;
    FrameStamp device_; ///< last one taken
    FrameStamp stamp_;
    std::int64_t jump_ns_ = 0;
    std::optional<std::int64_t> away_ns_;
};

} // namespace toile::openni2_sensor
