// Plays a body log on one avatar: camera to world, retargeting, velocities.
#pragma once

#include "body/position_retarget.h"
#include "kinect_log_source/kinect_log.h"

#include <optional>
#include <vector>

namespace toile::kinect_log_source {

/// The log's frames as people in the world: +Y up, the sensor stands on the +Z side and looks at
/// the person, who begins at x = z = 0; left stays left. The sensor's pitch and roll are taken out:
/// over the recording people stand upright on average (at most 12 degrees are corrected). Heights
/// are the sensor's; the floor is found by measure_person.
[[nodiscard]] std::vector<body::ObservedSkeleton> observe(const KinectLog& log);

/// One frame of one person on the avatar.
struct PlayedFrame {
    std::uint32_t sequence = 0;
    std::int64_t timestamp_ns = 0; ///< from the log's first frame
    body::JointTransforms joints;
    std::array<Vec3f, body::kJointCount> linear_velocity;  ///< m/s
    std::array<Vec3f, body::kJointCount> angular_velocity; ///< rad/s, world
    std::array<float, body::kJointCount> confidence{};
    enum class Tracking : std::uint8_t { invalid, tracked, uncertain, lost } tracking{};
};

/// Frame by frame; `advance` allocates nothing. Deterministic.
class LogPlayer {
  public:
    /// `volumes`: to ease arms out of the body; without them arms go where the log says.
    LogPlayer(const KinectLog& log, const body::Skeleton& skeleton,
              std::optional<body::BodyVolumes> volumes);

    /// False when the log is over.
    bool advance() noexcept;
    /// Of the frame last advanced to.
    [[nodiscard]] const PlayedFrame& frame() const noexcept { return frame_; }
    [[nodiscard]] float arm_depth() const noexcept { return arm_depth_; }
    [[nodiscard]] const body::ObservedPerson& person() const noexcept { return person_; }
    /// Forgets filters and velocities; the next frame stands for itself.
    void forget() noexcept;

  private:
    std::vector<body::ObservedSkeleton> observed_;
    std::vector<std::int64_t> times_ns_;
    body::ObservedPerson person_;
    body::PositionRetargeter retargeter_;
    PlayedFrame frame_;
    float arm_depth_ = 0.0f;
    std::size_t next_ = 0;
    bool fresh_ = true; ///< no history
};

} // namespace toile::kinect_log_source
