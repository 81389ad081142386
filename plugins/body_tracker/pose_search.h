// A person's pose from one frame alone: usual poses are drawn, compared with the grid, and the best
// ones moved onto it.
#pragma once

#include "body_tracker/registration.h"

#include <vector>

namespace toile::body_tracker {

struct FoundPose {
    body::Pose pose;
    Agreement agreement;
};

/// Keeps its work space; allocates only when made.
class PoseSearch {
  public:
    PoseSearch(const TrackedBody& body, const GridCamera& camera);

    /// `up`: unit, camera frame. `hint`: a pose that may be right too (the last one known).
    /// The best of several starts, moved onto the grid; the person is not to be believed when its
    /// agreement is bad. Deterministic.
    [[nodiscard]] FoundPose find(const SeenPerson& seen, const Vec3f& up, const body::Pose* hint,
                                 Registration& registration) noexcept;

  private:
    struct Candidate {
        body::Pose pose;
        float badness = 0.0f;
    };
    void place(const SeenPerson& seen, const Vec3f& up) noexcept;
    void add(const SeenPerson& seen, const body::Pose& pose, Registration& registration) noexcept;
    void improve_limbs(const SeenPerson& seen, Candidate& candidate,
                       Registration& registration) const noexcept;
    void refine(const SeenPerson& seen, Candidate& candidate, int rounds,
                Registration& registration) const noexcept;

    const TrackedBody& body_;
    std::vector<body::Pose> arms_; ///< ways of holding both arms
    std::vector<Candidate> best_;  ///< best first
    Vec3f top_ = Vec3f::Zero();    ///< camera frame: above the person's middle, at its top
    float down_m_ = 0.0f;          ///< from there to the lowest cell
};

} // namespace toile::body_tracker
