#include "pipeline/try_on_run.h"

#include "core/error.h"
#include "core/log.h"

#include <cstdio>
#include <thread>

namespace toile::pipeline {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kLateAfter_s = 0.02; // live clock: a frame later than this is not worth showing

std::span<const std::uint8_t> bytes_of(std::span<const Vec3f> positions) noexcept {
    return {reinterpret_cast<const std::uint8_t*>(positions.data()), positions.size_bytes()};
}

Latency latency_of(const DurationHistogram& histogram) {
    const Quantiles q = histogram.quantiles();
    return {q.median_ms, q.p95_ms};
}

} // namespace

TryOnRun::TryOnRun(FrameSource& source, DressedPerson& person, RunOptions options)
    : source_(source), person_(person), options_(std::move(options)) {
    if (options_.measure_contact) contact_ = std::make_unique<ContactWatch>(person_);
}

TryOnRun::~TryOnRun() = default;

bool TryOnRun::pull() {
    for (;;) {
        const toile_status status = source_.next(frame_);
        if (status == TOILE_OK) return true;
        if (status == TOILE_END_OF_STREAM) return false;
        if (status < 0) throw Error(source_.error());
        if (options_.interrupted && options_.interrupted()) return false;
        if (options_.realtime) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

bool TryOnRun::late() const noexcept {
    const double due =
        started_s_ + static_cast<double>(frame_.timestamp_ns - first_ns_) / kNsPerSecond;
    return wall_seconds() > due + kLateAfter_s;
}

void TryOnRun::wait_for_frame() const {
    const double due =
        started_s_ + static_cast<double>(frame_.timestamp_ns - first_ns_) / kNsPerSecond;
    const double wait = due - wall_seconds();
    if (wait > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(wait));
}

bool TryOnRun::next() {
    if (frame_open_) finish_frame();
    if (options_.most_frames && frames_ >= *options_.most_frames) return false;
    if (options_.interrupted && options_.interrupted()) return false;

    clock_.begin(Stage::source);
    bool there = pull();
    if (frames_ == 0) {
        first_ns_ = last_ns_ = frame_.timestamp_ns;
    } else if (options_.realtime) {
        while (there && late()) {
            ++dropped_;
            there = pull();
        }
    }
    clock_.end(Stage::source);
    if (!there) return false;
    if (frames_ > 0 && frame_.timestamp_ns <= last_ns_)
        throw Error("the source's time does not go on: frame " + std::to_string(frame_.sequence) +
                    " is not later than the one before it");

    if (frames_ == 0) {
        StageClock unmeasured;
        person_.start(frame_, unmeasured);
        started_s_ = wall_seconds();
    }
    if (options_.realtime) wait_for_frame();
    const double dt_s = static_cast<double>(frame_.timestamp_ns - last_ns_) / kNsPerSecond;
    person_.step(frame_, frames_ == 0 ? 1.0 / 30.0 : dt_s, clock_);
    last_ns_ = frame_.timestamp_ns;
    frame_open_ = true;
    ++frames_;

    const double due = started_s_ + static_cast<double>(last_ns_ - first_ns_) / kNsPerSecond;
    if (options_.realtime) state_latency_.add(wall_seconds() - due);
    for (const WornGarment& garment : person_.garments())
        digest_.add(bytes_of(garment.positions));
    if (contact_) contact_->measure(person_, frames_ - 1);
    return true;
}

void TryOnRun::begin_drawing() noexcept {
    clock_.begin(Stage::drawing);
}

void TryOnRun::end_drawing() noexcept {
    clock_.end(Stage::drawing);
    const double due = started_s_ + static_cast<double>(last_ns_ - first_ns_) / kNsPerSecond;
    if (options_.realtime) picture_latency_.add(wall_seconds() - due);
}

void TryOnRun::finish_frame() {
    clock_.end_frame();
    frame_open_ = false;
}

RunReport TryOnRun::report() const {
    RunReport report;
    report.frames = frames_;
    report.dropped = dropped_;
    for (std::size_t i = 0; i < kStageCount; ++i) {
        const auto stage = static_cast<Stage>(i);
        report.stages[std::string(stage_name(stage))] = clock_.stage(stage);
    }
    report.compute = clock_.compute();
    if (options_.realtime) {
        report.garment_state_latency = latency_of(state_latency_);
        if (picture_latency_.count() > 0) report.picture_latency = latency_of(picture_latency_);
    }
    if (contact_) report.contact = contact_->worst();
    report.positions_digest = digest_.hex();
    report.seed = options_.seed;
    return report;
}

} // namespace toile::pipeline
