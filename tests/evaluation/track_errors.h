// How far tracked people are from the truth of a simulated sensor, and the motions it is asked on.
#pragma once

#include "body/fit_model.h"
#include "body/test_person.h"
#include "body_tracker/body_tracking.h"
#include "body_tracker/part_painter.h"
#include "simulated_sensor/simulator.h"

#include <filesystem>
#include <map>

namespace toile::evaluation {

inline constexpr double kTrackRate = 30.0;
inline constexpr float kVisibleShare = 0.2f;

/// Share of each joint's part that a camera sees; beneath clothes: of which it sees the cloth,
/// within 6 cm.
class Visibility {
  public:
    explicit Visibility(const body::TestPerson& person);
    /// A body of the model: parts are what each joint leads.
    explicit Visibility(const body::FitLevel& level);
    /// `positions` (nv) world, as the camera has just seen them.
    [[nodiscard]] std::array<float, body::kJointCount>
    shares(const std::vector<Vec3f>& positions, const simulated_sensor::DepthCamera& camera) const;

  private:
    void weigh(const std::vector<Vec3f>& rest);

    std::vector<Triangle> triangles_;
    std::vector<std::size_t> joint_; // of each vertex
    std::vector<float> area_;
    std::array<float, body::kJointCount> total_{};
};

/// Upper arms and thighs, as `roll` has them.
inline constexpr std::array kRolled{body::Joint::left_upper_arm, body::Joint::right_upper_arm,
                                    body::Joint::left_upper_leg, body::Joint::right_upper_leg};

struct TrackSums {
    double visible = 0, all = 0; ///< millimetres
    std::size_t visible_count = 0, all_count = 0, near = 0;
    std::size_t frames = 0, called = 0, good_frames = 0, failed_frames = 0;
    std::size_t flagged = 0; ///< of the failed frames, those not called tracked
    std::size_t alarms = 0;  ///< of the good frames, those not called tracked
    std::array<double, body::kJointCount> joint{};
    std::array<std::size_t, body::kJointCount> joint_count{};
    std::array<std::size_t, body::kJointCount> off{}; ///< frames: visible, yet beyond 10 cm
    std::array<Vec3d, body::kJointCount> lean{};      ///< sum: right, up, to the camera, mm
    std::size_t swapped = 0, longest_swap = 0; ///< frames in which left and right are exchanged
    /// Degrees about the bone of upper arms and thighs (visible): [elbow or knee bent].
    std::array<double, 2> roll{};
    std::array<std::size_t, 2> roll_count{};
    /// The same without each limb's mean over a case: how far roll wanders, root of mean squares.
    std::array<double, 2> wander{};
    std::array<std::array<std::array<double, 3>, 2>, 4> limb{}; ///< count, sum, sum of squares
    std::array<std::array<std::size_t, 2>, 4> marks{}; ///< sought and found again, of kRolled
    std::array<std::array<double, 2>, 4> limb_off{}; ///< degrees, of kRolled: [elbow or knee bent]
    std::array<std::array<std::size_t, 2>, 4> limb_seen{};
    /// Of a pair of kRolled that begins with `first`.
    [[nodiscard]] double limb_roll(std::size_t first, std::size_t bent) const;
    [[nodiscard]] std::size_t limb_count(std::size_t first, std::size_t bent) const;
    /// Pixels that truly show the person, those labelled rightly and not at all; labels elsewhere.
    std::size_t labelled = 0, labels_right = 0, unlabelled = 0, labels_beside = 0;
    void end_case();
    /// By tenths of the stated confidence: joints, and how many of them are within 10 cm.
    std::array<std::size_t, 10> stated{}, kept{};
    std::vector<double> ms;
    TrackSums() { lean.fill(Vec3d::Zero()); }
    void add(const TrackSums& o);
};

/// What one frame shows: adds to `sums`. False when the person is not in view.
struct FrameErrors {
    bool in_view = false, good = true, failed = false, called_tracked = false;
    double visible_mm = 0.0;                       ///< mean of the visible joints
    std::array<float, body::kJointCount> off_mm{}; ///< of the visible joints; 0: not visible
};
FrameErrors compare(const simulated_sensor::Simulator& simulator, std::size_t figure,
                    const body_tracker::PersonTrack& person, const Visibility& visibility,
                    TrackSums& sums);

/// Compares the parts of pixels with those that rays hit; adds to `sums`.
void rate_labels(const simulated_sensor::Simulator& simulator,
                 const body_tracker::BodyTracking& tracking, const body::TestPerson& person,
                 body_tracker::PartPainter& painter, TrackSums& sums);

/// Are hips and shoulders nearer to the truth with left and right exchanged?
[[nodiscard]] bool swapped(const simulated_sensor::Simulator& simulator,
                           const body_tracker::PersonTrack& person);

[[nodiscard]] double percent(std::size_t a, std::size_t b);
void print(const std::string& name, TrackSums& sums);

/// Motions as track files in the folder for temporary files. A walk through random poses within the
/// joints' limits; and arms hanging, for longer than anybody looks.
[[nodiscard]] std::filesystem::path random_walk(const body::TestPerson& person, double seconds,
                                                std::uint64_t seed);
[[nodiscard]] std::filesystem::path stand_still(const body::TestPerson& person);

} // namespace toile::evaluation
