// A motion played as if it were a recorded person.
#pragma once

#include "body/motion.h"
#include "pipeline/frame_source.h"

namespace toile::pipeline {

/// Frames at a fixed rate over the whole motion, and then its last pose for `hold_s` more.
class MotionSource : public FrameSource {
  public:
    MotionSource(body::Motion motion, const body::Skeleton& skeleton, double frames_per_second,
                 double hold_s = 0.0);

    toile_status next(BodyFrame& out) noexcept override;
    [[nodiscard]] std::string error() override { return motion_.name; }

  private:
    body::Motion motion_;
    body::Skeleton skeleton_;
    double period_s_;
    std::uint32_t count_;
    std::uint32_t next_ = 0;
};

/// One pose that lasts.
[[nodiscard]] body::Motion still(const body::Pose& pose);

} // namespace toile::pipeline
