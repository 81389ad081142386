// Named points of a body between which tapes are laid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace toile::body {

/// Each is a point of the surface; docs/measurements.md says where a tailor feels for it. Left and
/// right are the person's; of a pair the left one stands first.
enum class Landmark : std::uint8_t {
    brow,       ///< above the bridge of the nose
    head_back,  ///< most prominent point of the back of the head
    larynx,     ///< front of the neck, just below the Adam's apple
    neck_back,  ///< tip of the seventh cervical vertebra
    neck_front, ///< pit between the collar bones
    navel,
    crotch, ///< lowest point of the trunk between the legs
    left_neck_side,
    right_neck_side, ///< where the side of the neck meets the shoulder line
    left_shoulder,
    right_shoulder, ///< acromion: outer end of the shoulder line
    left_armpit,
    right_armpit, ///< highest point of the hollow under the arm
    left_scye_front,
    right_scye_front, ///< front fold between arm and trunk, half-way up to the shoulder
    left_scye_back,
    right_scye_back, ///< the same behind
    left_bust_point,
    right_bust_point, ///< nipple
    left_under_bust,
    right_under_bust, ///< crease under the breast
    left_lowest_rib,
    right_lowest_rib, ///< at the side
    left_iliac_crest,
    right_iliac_crest, ///< top of the hip bone, at the side
    left_iliac_spine,
    right_iliac_spine, ///< front end of the hip bone's ridge
    left_trochanter,
    right_trochanter, ///< outermost point of the thigh bone
    left_gluteal_fold,
    right_gluteal_fold, ///< crease between buttock and thigh
    left_knee,
    right_knee, ///< middle of the knee cap
    left_lower_knee,
    right_lower_knee, ///< top of the shin bone, below the knee cap
    left_ankle,
    right_ankle, ///< outer ankle bone
    left_inner_ankle,
    right_inner_ankle,
    left_elbow,
    right_elbow, ///< olecranon, the tip of the elbow
    left_radiale,
    right_radiale, ///< outer side of the elbow's crease
    left_wrist,
    right_wrist, ///< wrist bone on the little finger's side
    left_inner_wrist,
    right_inner_wrist, ///< wrist bone on the thumb's side
    left_fingertip,
    right_fingertip, ///< of the middle finger
};
inline constexpr std::size_t kLandmarkCount = 49;

/// Name in files: "left_bust_point".
[[nodiscard]] std::string_view landmark_name(Landmark landmark);
[[nodiscard]] std::optional<Landmark> landmark_from_name(std::string_view name);
/// The one of the other side; those of the middle are their own.
[[nodiscard]] Landmark opposite(Landmark landmark);

} // namespace toile::body
