// Smooths a tracked pose: little lag when fast, little jitter when slow (One-Euro, Casiez 2012).
#pragma once

#include "body/rotations.h"
#include "body/skeleton.h"

namespace toile::body_tracker {

struct SmoothingOptions {
    bool on = true;
    float minimum_hz = 2.0f;    ///< cutoff at rest
    float slope_hz = 6.0f;      ///< more of it for each m/s of the hips
    float turn_slope_hz = 2.5f; ///< more of it for each rad/s of a joint
    float speed_hz = 4.0f;      ///< cutoff of the speeds' own filter
};

/// Filters the hips' place and each joint's turn; bones keep their lengths. The lag at a constant
/// speed is 1 / (2 pi cutoff).
class PoseSmoother {
  public:
    explicit PoseSmoother(const SmoothingOptions& options) : options_(options) {}
    void reset() noexcept { started_ = false; }

    /// `dt` since the last pose, seconds.
    const body::Pose& update(const body::Pose& pose, float dt) noexcept;

  private:
    SmoothingOptions options_;
    bool started_ = false;
    body::Pose last_, smooth_;
    Vec3f speed_ = Vec3f::Zero();
    std::array<Vec3f, body::kJointCount> turning_{};
};

} // namespace toile::body_tracker
