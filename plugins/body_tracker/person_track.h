// One person being followed from frame to frame.
#pragma once

#include "body_tracker/bone_distance.h"
#include "body_tracker/pose_search.h"
#include "body_tracker/pose_smoother.h"
#include "body_tracker/shape_learner.h"
#include "body_tracker/skin_marks.h"

#include <memory>

namespace toile::body_tracker {

enum class Following : std::uint8_t { invalid, detected, tracked, uncertain, lost };

struct TrackOptions {
    std::shared_ptr<const Forest> forest; ///< of body parts; null: depth alone decides
    RegistrationOptions registration;
    SmoothingOptions smoothing;
    MarkOptions marks;          ///< of the colour picture
    int steps = 4;              ///< Gauss-Newton steps a frame at most
    double settled_rad = 0.012; ///< a step that turns no joint farther is the last
    bool learn_shape = true;
    bool recover = true;          ///< searches anew after a failure
    float failed_error_m = 0.06f; ///< mean distance that means a failure (P5 3.6), and ...
    float failed_share = 0.11f;   ///< ... share not explained (P5's 0.15 overlooks single limbs)
};

/// Made once and reused for person after person; per frame nothing allocates once the shape is
/// known.
class PersonTrack {
  public:
    PersonTrack(const body::FitModel& model, const GridCamera& camera, const TrackOptions& options);

    /// Looks for somebody new: false when what is seen is nobody. At first the pose is rough; the
    /// next frames' `follow` goes on with the search, and stops the track when nobody was there
    /// after all.
    bool start(std::uint32_t id, const SeenPerson& seen, const Vec3f& up) noexcept;
    /// Where the person should be after `dt` seconds; before `follow` of the same frame.
    void predict(float dt) noexcept;
    void follow(const SeenPerson& seen, const Vec3f& up, float dt) noexcept;
    void stop() noexcept { id_ = 0; }

    [[nodiscard]] bool active() const noexcept { return id_ != 0; }
    [[nodiscard]] std::uint32_t id() const noexcept { return id_; }
    [[nodiscard]] Following following() const noexcept { return following_; }
    /// Is the first search over? Before that the person may turn out to be a thing.
    [[nodiscard]] bool sure() const noexcept { return sure_; }
    [[nodiscard]] float unseen_s() const noexcept { return unseen_s_; }
    [[nodiscard]] const Agreement& agreement() const noexcept { return agreement_; }
    [[nodiscard]] const BoneDistance& bones() const noexcept { return bones_; }
    [[nodiscard]] const body::Pose& pose() const noexcept { return pose_; }
    [[nodiscard]] const TrackedBody& body() const noexcept { return body_; }
    [[nodiscard]] std::uint32_t shape_version() const noexcept { return shape_version_; }
    [[nodiscard]] PersonMask& mask() noexcept { return mask_; }
    [[nodiscard]] const PersonMask& mask() const noexcept { return mask_; }
    [[nodiscard]] const Registration& registration() const noexcept { return registration_; }
    [[nodiscard]] const SkinMarks& marks() const noexcept { return marks_; }

    /// Of a joint in the camera's frame, m/s and rad/s; 0 in the first frame.
    [[nodiscard]] const Vec3f& velocity(std::size_t joint) const noexcept {
        return velocity_[joint];
    }
    [[nodiscard]] const Vec3f& angular_velocity(std::size_t joint) const noexcept {
        return turning_[joint];
    }

    /// Smoothed, camera_from_joint; confidence in [0, 1].
    [[nodiscard]] const body::JointTransforms& joints() const noexcept { return joints_; }
    [[nodiscard]] const std::array<float, body::kJointCount>& confidence() const noexcept {
        return confidence_;
    }

  private:
    void follow_marks(const SeenPerson& seen, body::Pose& pose) noexcept;
    void settle(const SeenPerson& seen, float dt) noexcept;
    void recover(const SeenPerson& seen, const Vec3f& up) noexcept;
    void rate_joints(const SeenPerson& seen) noexcept;
    void show(float dt) noexcept;
    void measure_height(const SeenPerson& seen, const Vec3f& up) noexcept;
    void try_turned(const SeenPerson& seen) noexcept;
    void try_arm(const SeenPerson& seen) noexcept;
    void drift(const SeenPerson& seen, const Vec3f& hips, float dt) noexcept;
    [[nodiscard]] bool failed() const noexcept;

    TrackOptions options_;
    TrackedBody body_;
    PartsView parts_;
    Registration registration_;
    PoseSearch search_;
    SkinMarks marks_;
    ShapeLearner learner_;
    PoseSmoother smoother_;
    PersonMask mask_;
    BoneDistance bones_;
    MotionPrior motion_;
    std::uint32_t id_ = 0;
    std::uint32_t shape_version_ = 0;
    Following following_ = Following::lost;
    body::Pose pose_, last_;
    bool moving_ = false; ///< last_ is of the frame before
    Agreement agreement_;
    int failures_ = 0; ///< frames in a row
    bool recovering_ = false;
    bool height_known_ = false;    ///< told when the top of the head is in view
    bool whole_ = false;           ///< was in view from head to feet
    bool sure_ = false;            ///< that it is somebody: the first search is over
    int since_turned_ = 0;         ///< frames since the other facing was tried
    int since_arm_ = 0;            ///< and since an arm was
    bool left_arm_ = false;        ///< which that was
    float usual_ = 0.0f;           ///< not explained, as a rule: clothes are wider than the body
    Vec3f drift_ = Vec3f::Zero();  ///< of the hips, m/s, over some frames
    Vec3f middle_ = Vec3f::Zero(); ///< of the cells of the frame before
    float known_s_ = 0.0f;         ///< since the person was found
    float unseen_s_ = 0.0f;
    float astray_s_ = 0.0f; ///< how long the pose has explained little
    body::JointTransforms joints_;
    std::array<Vec3f, body::kJointCount> velocity_{}, turning_{};
    std::array<float, body::kJointCount> confidence_{};
    std::array<float, body::kJointCount> part_area_{}; ///< m^2 of the skin that each joint leads
};

} // namespace toile::body_tracker
