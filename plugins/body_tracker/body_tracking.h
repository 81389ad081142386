// People before one depth camera, frame by frame.
#pragma once

#include "body_tracker/person_track.h"
#include "body_tracker/scene_watch.h"

#include <array>
#include <memory>

namespace toile::body_tracker {

inline constexpr std::size_t kMostPeople = 6;

struct TrackingOptions {
    TrackOptions person;
    std::size_t most_people = 1;
    float forget_s = 1.5f; ///< after so long out of sight a person is given up
};

/// Where the camera stands, when that is known; the world's floor is y = 0.
using CameraPlace = std::optional<Eigen::Isometry3d>;

/// Lock-step: the same frames give the same people, whatever the machine does meanwhile.
class BodyTracking {
  public:
    /// \throw Error when the camera makes no sense
    BodyTracking(const body::FitModel& model, const imaging::Intrinsics& camera,
                 const CameraPlace& world_from_camera, const TrackingOptions& options);

    /// The next picture: metres (width * height), NaN where unknown. Times that go back or leap by
    /// more than a second count as a usual step. `rgba` (width * height * 4): the colour picture,
    /// when there is one that is registered to the depth.
    void update(const float* metres, std::int64_t timestamp_ns,
                const std::uint8_t* rgba = nullptr) noexcept;

    [[nodiscard]] std::span<const std::unique_ptr<PersonTrack>> people() const noexcept {
        return people_;
    }
    [[nodiscard]] const SceneWatch& scene() const noexcept { return scene_; }
    [[nodiscard]] const DepthGrid& grid() const noexcept { return grid_; }

  private:
    /// Where a piece was no person, and how often.
    struct Doubt {
        Vec3f place = Vec3f::Zero();
        std::uint32_t times = 0;
    };
    [[nodiscard]] float step_to(std::int64_t timestamp_ns) noexcept;
    [[nodiscard]] std::uint8_t nearest_person(const Vec3f& point, float within) const noexcept;
    [[nodiscard]] bool like_a_person(std::uint16_t label) const noexcept;
    void share_out() noexcept;
    void take_picture(const std::uint8_t* rgba) noexcept;
    void follow_all(float dt) noexcept;
    void welcome() noexcept;
    [[nodiscard]] bool look_at(const Piece& piece) noexcept;
    [[nodiscard]] Doubt* doubt_near(const Vec3f& place) noexcept;
    void doubt(const Piece& piece) noexcept;
    void forget(std::uint32_t id, PersonTrack& person) noexcept;
    [[nodiscard]] SeenPerson seen_by(PersonTrack& person) const noexcept;
    [[nodiscard]] bool mask_piece(const Piece& piece, PersonTrack& person) const noexcept;
    [[nodiscard]] PersonTrack* remembered_near(const Vec3f& place) noexcept;
    [[nodiscard]] PersonTrack* free_track() noexcept;

    TrackingOptions options_;
    DepthReducer reducer_;
    DepthGrid grid_;
    GreyPicture picture_;
    SceneWatch scene_;
    std::vector<std::unique_ptr<PersonTrack>> people_;
    std::vector<std::uint8_t> owner_; ///< (cells) 1 + person, 0: nobody's
    std::vector<std::uint32_t> stack_;
    std::uint32_t next_id_ = 1;
    std::array<Doubt, 8> doubts_{};
    std::int64_t last_ns_ = 0;
    bool started_ = false;
};

} // namespace toile::body_tracker
