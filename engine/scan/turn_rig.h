// Where cameras stand to each other that see the same thing turn, from how it turns before each:
// they need not see the same places at one time (P2: three cameras).
#pragma once

#include "scan/rig_fusion.h"

#include <span>
#include <string>

namespace toile::scan {

/// What one camera saw of the turn, in coordinates of the turn's axis: y along it.
struct TurnTrack {
    Pose axis_from_camera = Pose::Identity();
    std::vector<Vec3f> points, normals; ///< of the subject as it stood in the first picture
    double turn_rad = 0.0;
    std::size_t pictures = 0; ///< that fit
};

/// Follows the subject through one camera's pictures, in order, the first with the same instant for
/// all cameras, and finds the axis of its turn.
[[nodiscard]] TurnTrack follow_turn(std::span<const DepthView> pictures, const RowLoop& rows);

/// Least turn for which the axis is told well.
inline constexpr double kLeastTurn_rad = 2.5;

/// The axes are laid on each other; how far along and how much about it, the surfaces tell, best
/// where they share some height. First camera from each. `names` are for errors.
/// \throw Error when a camera saw no turn, or its surface meets no other one
[[nodiscard]] std::vector<Pose> places_from_turns(std::span<const TurnTrack> tracks,
                                                  std::span<const std::string> names);

} // namespace toile::scan
