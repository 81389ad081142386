// How long the stages of a frame take, in bounded memory however long the mirror runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace toile::pipeline {

/// The stages of one frame, in the order they run.
enum class Stage : std::uint8_t { source, skinning, targets, cloth, surfaces, drawing };
inline constexpr std::size_t kStageCount = 6;
[[nodiscard]] std::string_view stage_name(Stage stage);

struct Quantiles {
    double median_ms = 0.0;
    double p95_ms = 0.0;
    double max_ms = 0.0;
};

/// Durations in logarithmic bins 1.1 % wide, from 1 microsecond to 1000 s; the maximum is exact.
class DurationHistogram {
  public:
    void add(double seconds) noexcept;
    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] Quantiles quantiles() const;

  private:
    static constexpr int kBinsPerOctave = 64;
    static constexpr int kOctaves = 30;
    [[nodiscard]] double quantile_seconds(double share) const;

    std::array<std::uint32_t, std::size_t{kBinsPerOctave} * kOctaves> bins_{};
    std::uint64_t count_ = 0;
    double max_s_ = 0.0;
};

/// CPU seconds of the whole process, all threads.
[[nodiscard]] double cpu_seconds() noexcept;
/// Wall seconds of a clock that never goes back.
[[nodiscard]] double wall_seconds() noexcept;

/// CPU time per stage, and of all stages but drawing together (`compute`). A stage may run several
/// times within a frame; its parts add up.
class StageClock {
  public:
    void begin(Stage stage) noexcept;
    void end(Stage stage) noexcept;
    void end_frame() noexcept;

    [[nodiscard]] Quantiles stage(Stage stage) const;
    [[nodiscard]] Quantiles compute() const { return compute_.quantiles(); }
    [[nodiscard]] std::uint64_t frames() const { return compute_.count(); }

  private:
    std::array<DurationHistogram, kStageCount> stages_;
    std::array<double, kStageCount> started_{};
    std::array<double, kStageCount> spent_{};
    DurationHistogram compute_;
};

} // namespace toile::pipeline
