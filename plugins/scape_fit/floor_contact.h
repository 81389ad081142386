// Feet and the floor: near it they stand on it, and none is beneath it.
#pragma once

#include "geometry/slice.h"
#include "scape_fit/association_types.h"
#include "scape_fit/fit_model.h"

namespace toile::scape_fit {

inline constexpr float kFootReach = 0.05f;   ///< metres: a higher foot is lifted
inline constexpr float kFootWeight = 0.004f; ///< m^2 that a sole counts as

/// What the floor says of each foot, at its lowest vertex: to come down to it from up to
/// kFootReach, and to come up from wherever below. A foot deep in the floor has no points that
/// would draw it out, since what is close to the floor was cut off with it: only the floor does.
/// `floor`: unit normal up. `out` is cleared first.
void stand_on(const FitLevel& level, const PosedLevel& posed, const geometry::Plane& floor,
              Association& out);

} // namespace toile::scape_fit
