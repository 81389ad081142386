// Both legs from where hips and feet are: feet that stand do not slide, knees bend forward.
#pragma once

#include "body/skeleton.h"

namespace toile::body {

/// What was seen of one leg, world, metres of the avatar.
struct LegTarget {
    Vec3f ankle;         ///< its height counts from the rest height: planted = rest ankle height
    Vec3f knee;          ///< for the plane in which the knee bends
    Vec3f toe_direction; ///< ankle to toes, any length
    float confidence = 0.0f; ///< 0: the leg is out of view and stands below the hips
};

/// Two-bone legs under given hips. A foot near the floor that hardly moves is locked where it
/// stands; when its target has gone too far it steps after it, one foot at a time.
class LegSolver {
  public:
    explicit LegSolver(const Skeleton& skeleton);

    void reset() noexcept { started_ = false; }

    /// Fills the legs of `world`; the hips' rotation and position are set, and lowered here when a
    /// foot would not reach the floor. dt in seconds, 0 for a first frame.
    void solve(const std::array<LegTarget, 2>& seen, float dt, JointTransforms& world) noexcept;

  private:
    struct Foot {
        Vec3f ankle = Vec3f::Zero();  ///< where it is
        Vec3f lock = Vec3f::Zero();   ///< where it stands while planted
        Vec3f behind = Vec3f::Zero(); ///< from the target to the foot while it catches up
        float yaw = 0.0f;             ///< of the foot, relative to rest, world
        float knee_turn = 0.0f;       ///< of the knee's plane, relative to the pelvis
        float trust = 0.0f;
        float lift = 0.0f; ///< above the planted height
        bool planted = false;
        Vec3f last_target = Vec3f::Zero();
    };

    void place_foot(std::size_t side, const LegTarget& seen, float dt,
                    const RigidTransform& hips) noexcept;
    [[nodiscard]] Vec3f neutral_ankle(std::size_t side, const RigidTransform& hips) const noexcept;
    void bend_leg(std::size_t side, const LegTarget& seen, float dt,
                  JointTransforms& world) noexcept;

    Skeleton skeleton_;
    std::array<Foot, 2> feet_;
    std::array<float, 2> reach_; ///< longest hip to ankle, a little less than straight
    bool started_ = false;
};

} // namespace toile::body
