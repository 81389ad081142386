// A person's pose without any frame before: usual poses are drawn and compared with the grid, and
// the best ones moved onto it. The work is spread over three frames, so that none takes long.
#pragma once

#include "body_tracker/arm_aim.h"
#include "body_tracker/parts_view.h"

#include <optional>
#include <vector>

namespace toile::body_tracker {

struct FoundPose {
    body::Pose pose;
    Agreement agreement;
    float badness = 0.0f; ///< as `rate` has it
};

/// Keeps its work space; allocates only when made.
class PoseSearch {
  public:
    /// `parts` is asked once a frame in which a search goes on; must outlive it.
    PoseSearch(const TrackedBody& body, PartsView& parts, const GridCamera& camera);

    /// Begins anew.
    void restart() noexcept { stage_ = Stage::library; }

    /// Where the person goes, m/s, camera frame: few walk backwards. Counts until it is told anew.
    void expect(const Vec3f& drift) noexcept { drift_ = drift; }

    /// Goes on with one frame. `up`: unit, camera frame. `hint`: a pose that may be right too (the
    /// last one known). In the third frame the best pose; the person is not to be believed when its
    /// agreement is bad. Deterministic.
    [[nodiscard]] std::optional<FoundPose> advance(const SeenPerson& seen, const Vec3f& up,
                                                   const body::Pose* hint,
                                                   Registration& registration) noexcept;

    /// How badly a pose explains the grid and what the forest said when `parts` last looked; lower
    /// is better. `registration` is left with the pose judged.
    [[nodiscard]] float rate(const SeenPerson& seen, const body::Pose& pose,
                             Registration& registration, bool whole = true) const noexcept;

    /// Tries usual ways of holding one arm in place of the pose's, and reaching for what is not
    /// explained; true when `pose` was changed for a better one. `parts` must have looked.
    bool retry_arm(const SeenPerson& seen, bool left, const RegistrationOptions& options,
                   body::Pose& pose, Registration& registration) noexcept;

    /// The best pose so far, for use before the search is over; after the first frame of one.
    [[nodiscard]] const body::Pose& provisional() const noexcept { return best_.front().pose; }

    /// The same outline with the person facing the other way: what a camera may take for the pose.
    [[nodiscard]] static body::Pose turned_around(const body::Pose& pose) noexcept;

    /// The person's height above the floor in that frame; nothing when the floor or the top of the
    /// head is not in view.
    [[nodiscard]] static std::optional<float> height_of(const SeenPerson& seen,
                                                        const Vec3f& up) noexcept;

  private:
    enum class Stage : std::uint8_t { library, limbs, refinement };
    struct Candidate {
        body::Pose pose;
        float badness = 0.0f;
    };
    void look_through_library(const SeenPerson& seen, const Vec3f& up, const body::Pose* hint,
                              Registration& registration) noexcept;
    [[nodiscard]] Vec3f hips_place(const SeenPerson& seen, const Vec3f& up) const noexcept;
    void keep(const SeenPerson& seen, const body::Pose& pose, Registration& registration) noexcept;
    void improve_limbs(const SeenPerson& seen, Candidate& candidate,
                       Registration& registration) noexcept;
    void refine(const SeenPerson& seen, Candidate& candidate, int rounds,
                Registration& registration) const noexcept;
    void sort() noexcept;

    const TrackedBody& body_;
    PartsView& parts_;
    ArmAim aim_;
    std::vector<body::Pose> arms_; ///< ways of holding both arms
    std::vector<Candidate> best_;  ///< best first
    Stage stage_ = Stage::library;
    Vec3f drift_ = Vec3f::Zero();
};

} // namespace toile::body_tracker
