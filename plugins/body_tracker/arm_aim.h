// Where an arm may have gone: ways of holding it that reach for what a pose leaves unexplained.
#pragma once

#include "body_tracker/registration.h"

#include <vector>

namespace toile::body_tracker {

/// Keeps its work space; allocates only when made.
class ArmAim {
  public:
    explicit ArmAim(const GridCamera& camera);

    /// Poses with another left or right arm, whose hand is where a piece of the person that the
    /// pose does not explain ends, and whose elbow is nowhere where the camera sees past it. They
    /// are rough: to be moved onto the grid and judged. `registration` has just judged `pose`.
    /// Empty when all is explained, or out of reach. Valid until the next call.
    [[nodiscard]] std::span<const body::Pose> reach(const SeenPerson& seen, const TrackedBody& body,
                                                    const Registration& registration,
                                                    const body::Pose& pose, bool left) noexcept;

  private:
    /// One shoulder, and how long the bones beyond it are; metres, camera frame.
    struct Arm {
        Vec3f shoulder;
        float upper = 0.0f, lower = 0.0f; ///< lower: to the palm
    };
    void find_tips(const SeenPerson& seen, const Registration& registration,
                   const Arm& arm) noexcept;
    void bend_towards(const SeenPerson& seen, const TrackedBody& body,
                      const body::JointTransforms& joints, const body::Pose& pose, const Arm& arm,
                      const Vec3f& tip, bool left) noexcept;
    [[nodiscard]] float misfit(const SeenPerson& seen, const Vec3f& from,
                               const Vec3f& to) const noexcept;

    GridCamera camera_;
    std::vector<Vec3f> tips_;
    std::vector<body::Pose> poses_;
};

} // namespace toile::body_tracker
