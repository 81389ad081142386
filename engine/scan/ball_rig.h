// Where cameras stand to each other, from a ball that is moved about before them.
#pragma once

#include "scan/ball.h"
#include "scan/rig_motion.h"

namespace toile::scan {

/// (cameras) x (instants): nothing where no ball was found.
using SeenBalls = std::vector<std::vector<std::optional<FoundBall>>>;

struct BallRig {
    SolvedRig rig;
    double radius_m = 0.0;
};

/// One radius for all pictures (`known_radius_m`, or 0: the median of what they tell by
/// themselves), each ball fitted again with it, then the cameras from its centres. `focal`
/// (cameras): pixels. \throw Error as solve_rig, or when no picture shows a ball
[[nodiscard]] BallRig rig_from_balls(const SeenBalls& seen, std::span<const double> focal,
                                     std::span<const std::string> names, double known_radius_m);

} // namespace toile::scan
