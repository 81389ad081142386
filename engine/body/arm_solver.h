// One arm's joint rotations from where its bones point: no candy-wrapper, elbows that bend forward.
#pragma once

#include "body/skeleton.h"

namespace toile::body {

/// What was seen of one arm; unit vectors in the world. Confidences in [0, 1].
struct ArmDirections {
    Vec3f upper, lower, hand; ///< along the bones, away from the body
    Vec3f thumb;              ///< from the wrist to the thumb's tip, any length
    float hand_confidence = 0.0f;
    float thumb_confidence = 0.0f;
};

/// Bones point exactly as told. The roll of the upper arm comes from the plane in which the elbow
/// bends (held and relaxed while the arm is straight), that of the forearm from the thumb, half of
/// it taken by the forearm and half by the hand. Keeps the rolls of the last frame.
class ArmSolver {
  public:
    /// side: 0 left, 1 right.
    ArmSolver(const Skeleton& skeleton, std::size_t side);

    void reset() noexcept { started_ = false; }

    /// Fills upper arm, lower arm and hand of `world`, whose shoulder joint is set. `chest` is the
    /// world rotation of the upper chest. dt in seconds, 0 for a first frame.
    void solve(const Quatf& chest, const ArmDirections& seen, float dt,
               JointTransforms& world) noexcept;

  private:
    [[nodiscard]] float upper_roll(const Vec3f& forward, const ArmDirections& seen,
                                   float dt) noexcept;
    [[nodiscard]] float forearm_roll(const Quatf& lower, const ArmDirections& seen,
                                     float dt) noexcept;

    std::array<Vec3f, 4> offset_; ///< rest offsets of upper arm, lower arm, hand; last unused
    std::size_t first_;           ///< joint index of the upper arm
    Vec3f upper_, lower_;         ///< rest directions of the bones
    Vec3f forward_;               ///< where the elbow bends to at rest, across the upper arm
    Vec3f reference_;             ///< arm direction, in the chest, from which swings are counted
    Quatf reference_from_rest_;
    float upper_roll_ = 0.0f;
    float forearm_roll_ = 0.0f;
    Quatf hand_swing_ = Quatf::Identity();
    bool started_ = false;
};

} // namespace toile::body
