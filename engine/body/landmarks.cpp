#include "body/landmarks.h"

#include <array>

namespace toile::body {
namespace {

constexpr std::array<std::string_view, kLandmarkCount> kNames = {
    "brow",
    "head_back",
    "larynx",
    "neck_back",
    "neck_front",
    "navel",
    "crotch",
    "left_neck_side",
    "right_neck_side",
    "left_shoulder",
    "right_shoulder",
    "left_armpit",
    "right_armpit",
    "left_scye_front",
    "right_scye_front",
    "left_scye_back",
    "right_scye_back",
    "left_bust_point",
    "right_bust_point",
    "left_under_bust",
    "right_under_bust",
    "left_lowest_rib",
    "right_lowest_rib",
    "left_iliac_crest",
    "right_iliac_crest",
    "left_iliac_spine",
    "right_iliac_spine",
    "left_trochanter",
    "right_trochanter",
    "left_gluteal_fold",
    "right_gluteal_fold",
    "left_knee",
    "right_knee",
    "left_lower_knee",
    "right_lower_knee",
    "left_ankle",
    "right_ankle",
    "left_inner_ankle",
    "right_inner_ankle",
    "left_elbow",
    "right_elbow",
    "left_radiale",
    "right_radiale",
    "left_wrist",
    "right_wrist",
    "left_inner_wrist",
    "right_inner_wrist",
    "left_fingertip",
    "right_fingertip",
};

constexpr std::size_t kFirstPair = static_cast<std::size_t>(Landmark::left_neck_side);
static_assert(static_cast<std::size_t>(Landmark::right_fingertip) + 1 == kLandmarkCount);

} // namespace

std::string_view landmark_name(Landmark landmark) {
    return kNames.at(static_cast<std::size_t>(landmark));
}

std::optional<Landmark> landmark_from_name(std::string_view name) {
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (kNames[i] == name) return static_cast<Landmark>(i);
    return std::nullopt;
}

Landmark opposite(Landmark landmark) {
    const auto i = static_cast<std::size_t>(landmark);
    if (i < kFirstPair) return landmark;
    return static_cast<Landmark>((i - kFirstPair) % 2 == 0 ? i + 1 : i - 1);
}

} // namespace toile::body
