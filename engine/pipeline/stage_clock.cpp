#include "pipeline/stage_clock.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace toile::pipeline {
namespace {

constexpr double kSmallest = 1e-6;

double seconds_of(clockid_t clock) noexcept {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace

std::string_view stage_name(Stage stage) {
    constexpr std::array<std::string_view, kStageCount> kNames = {"source", "skinning", "targets",
                                                                  "cloth",  "surfaces", "drawing"};
    return kNames[static_cast<std::size_t>(stage)];
}

double cpu_seconds() noexcept {
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double wall_seconds() noexcept {
    return seconds_of(CLOCK_MONOTONIC);
}

void DurationHistogram::add(double seconds) noexcept {
    const double octave = std::log2(std::max(seconds, kSmallest) / kSmallest);
    const auto bin = static_cast<std::size_t>(octave * kBinsPerOctave);
    ++bins_[std::min(bin, bins_.size() - 1)];
    ++count_;
    max_s_ = std::max(max_s_, seconds);
}

double DurationHistogram::quantile_seconds(double share) const {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        seen += bins_[i];
        if (seen < std::max<std::uint64_t>(wanted, 1)) continue;
        const double middle = (static_cast<double>(i) + 0.5) / kBinsPerOctave;
        return std::min(kSmallest * std::exp2(middle), max_s_);
    }
    return 0.0;
}

Quantiles DurationHistogram::quantiles() const {
    if (count_ == 0) return {};
    return {1e3 * quantile_seconds(0.5), 1e3 * quantile_seconds(0.95), 1e3 * max_s_};
}

void StageClock::begin(Stage stage) noexcept {
    started_[static_cast<std::size_t>(stage)] = cpu_seconds();
}

void StageClock::end(Stage stage) noexcept {
    const auto i = static_cast<std::size_t>(stage);
    spent_[i] += cpu_seconds() - started_[i];
}

void StageClock::end_frame() noexcept {
    double compute = 0.0;
    for (std::size_t i = 0; i < kStageCount; ++i) {
        stages_[i].add(spent_[i]);
        if (static_cast<Stage>(i) != Stage::drawing) compute += spent_[i];
        spent_[i] = 0.0;
    }
    compute_.add(compute);
}

Quantiles StageClock::stage(Stage stage) const {
    return stages_[static_cast<std::size_t>(stage)].quantiles();
}

} // namespace toile::pipeline
