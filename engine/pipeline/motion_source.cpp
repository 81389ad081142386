#include "pipeline/motion_source.h"

#include <cmath>

namespace toile::pipeline {

MotionSource::MotionSource(body::Motion motion, const body::Skeleton& skeleton,
                           double frames_per_second, double hold_s)
    : motion_(std::move(motion)), skeleton_(skeleton), period_s_(1.0 / frames_per_second),
      count_(1 + static_cast<std::uint32_t>(
                     std::floor((motion_.duration() + hold_s) * frames_per_second + 1e-6))) {}

toile_status MotionSource::next(BodyFrame& out) noexcept {
    if (next_ >= count_) return TOILE_END_OF_STREAM;
    const double time_s = period_s_ * next_;
    out = BodyFrame();
    out.sequence = next_++;
    out.timestamp_ns = static_cast<std::int64_t>(std::llround(time_s * 1e9));
    out.joints =
        joints_of(body::forward_kinematics(skeleton_, body::sample(motion_, time_s)), 1.0f);
    return TOILE_OK;
}

body::Motion still(const body::Pose& pose) {
    body::Motion out;
    out.name = "still";
    out.times = {0.0};
    out.poses = {pose};
    return out;
}

} // namespace toile::pipeline
