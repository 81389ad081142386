// From joint positions as a depth sensor's tracker sees them to a pose of a given body.
#pragma once

#include "body/arm_solver.h"
#include "body/body_volumes.h"
#include "body/leg_solver.h"
#include "body/rotations.h"

#include <optional>
#include <span>

namespace toile::body {

/// One person in one frame: metres, +Y up, right-handed, left is the person's left.
struct ObservedSkeleton {
    std::array<Vec3f, kJointCount> positions;
    std::array<float, kJointCount> confidence{}; ///< 1 tracked, less inferred, 0 not seen
    std::array<Vec3f, 2> fingertip;              ///< left, right
    std::array<Vec3f, 2> thumb;
    std::array<float, 2> fingertip_confidence{};
    std::array<float, 2> thumb_confidence{};
};

/// What is constant about one observed person, and about the tracker's habits.
struct ObservedPerson {
    float scale = 1.0f;                  ///< avatar's metres per observed metre
    std::array<float, 2> ankle_height{}; ///< observed y of the planted left and right ankle
    float hips_raise = 0.0f;  ///< the same for the hips' height: legs stand straight at the median
    float ankle_ahead = 0.0f; ///< trackers' bias: to add to ankles, avatar's metres
    std::array<Vec3f, 2> shoulder_direction; ///< neutral, neck to shoulder, in the chest
    Vec3f neck_direction = Vec3f::UnitY();   ///< neutral, in the chest
    float hips_height = 0.9f;                ///< median, observed
    bool legs_seen = true;                   ///< false: feet were mostly out of view
};

/// Medians over a recording (or its first seconds). Legs that were hardly tracked do not count: the
/// floor is then where the avatar's legs end below the hips.
[[nodiscard]] ObservedPerson measure_person(const Skeleton& skeleton,
                                            std::span<const ObservedSkeleton> frames);

struct RetargetedFrame {
    JointTransforms joints; ///< bone lengths are the avatar's
    std::array<float, kJointCount> confidence{};
    float arm_depth = 0.0f; ///< deepest arm sample left inside the body, metres
};

/// Poses one body frame by frame. Bones point where they were seen to; shoulders, neck and head add
/// their share; hips move by the scaled motion; arms are eased out of the body. Points pass a
/// One-Euro filter (lag at rest 53 ms, at 1 m/s 25 ms); inferred points a slow one; points not seen
/// relax to a neutral pose. Deterministic; update allocates nothing.
class PositionRetargeter {
  public:
    PositionRetargeter(const Skeleton& skeleton, const ObservedPerson& person,
                       std::optional<BodyVolumes> volumes);

    void reset() noexcept;

    /// dt: seconds since the last frame (any value for the first).
    const RetargetedFrame& update(const ObservedSkeleton& seen, float dt) noexcept;

  private:
    void filter(const ObservedSkeleton& seen, float dt) noexcept;
    [[nodiscard]] Vec3f neutral_point(Joint joint) const noexcept;
    void solve_trunk() noexcept;
    void place_trunk() noexcept;
    void solve_shoulder(std::size_t side) noexcept;
    void solve_head() noexcept;
    void solve_arms(float dt) noexcept;
    void solve_legs(float dt) noexcept;
    [[nodiscard]] const Vec3f& point(Joint joint) const noexcept;

    Skeleton skeleton_;
    ObservedPerson person_;
    std::optional<BodyVolumes> volumes_;
    std::array<ArmSolver, 2> arms_;
    LegSolver legs_;
    std::array<PointFilter, kJointCount> points_;
    std::array<PointFilter, 2> fingertips_;
    std::array<PointFilter, 2> thumbs_;
    std::array<float, 2> fingertip_confidence_{};
    std::array<float, 2> thumb_confidence_{};
    Quatf observed_chest_ = Quatf::Identity();
    RetargetedFrame frame_;
    bool started_ = false;
};

} // namespace toile::body
