// The main job: frame after frame from a source to a dressed person, with its figures.
#pragma once

#include "core/digest.h"
#include "pipeline/contact_watch.h"
#include "pipeline/dressed_person.h"
#include "pipeline/frame_source.h"
#include "pipeline/run_report.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace toile::pipeline {

struct RunOptions {
    /// Live clock: frames keep their distance in time, late ones are dropped and counted. Otherwise
    /// lock-step: every frame, as fast as it goes.
    bool realtime = false;
    std::optional<std::uint64_t> most_frames;
    /// Measure contact and visible skin in every frame (slow: several times the frame itself).
    bool measure_contact = false;
    std::uint64_t seed = 1;
    std::function<bool()> interrupted; ///< asked before each frame; empty: never
};

/// One person through one source. Not movable.
class TryOnRun {
  public:
    TryOnRun(FrameSource& source, DressedPerson& person, RunOptions options);
    ~TryOnRun();
    TryOnRun(const TryOnRun&) = delete;
    TryOnRun& operator=(const TryOnRun&) = delete;

    /// Moves on by one frame; false when the source is over, `most_frames` were shown or the run
    /// was interrupted. \throw Error when the source fails
    bool next();
    [[nodiscard]] const BodyFrame& frame() const noexcept { return frame_; }

    /// Tells that drawing begins and that the picture is out; counts towards `drawing` and the
    /// picture's latency.
    void begin_drawing() noexcept;
    void end_drawing() noexcept;

    /// Figures so far.
    [[nodiscard]] RunReport report() const;

  private:
    bool pull();
    bool late() const noexcept;
    void wait_for_frame() const;
    void finish_frame();

    FrameSource& source_;
    DressedPerson& person_;
    RunOptions options_;
    StageClock clock_;
    BodyFrame frame_;
    std::int64_t last_ns_ = 0;
    std::int64_t first_ns_ = 0;
    double started_s_ = 0.0;
    std::uint64_t frames_ = 0;
    std::uint64_t dropped_ = 0;
    Digest digest_;
    DurationHistogram state_latency_;
    DurationHistogram picture_latency_;
    std::unique_ptr<ContactWatch> contact_;
    bool frame_open_ = false;
};

} // namespace toile::pipeline
