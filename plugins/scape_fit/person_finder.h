// Which of the observed points are the person: floor, walls and clutter taken away.
#pragma once

#include "geometry/slice.h"
#include "scape_fit/observation.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::scape_fit {

struct FoundPerson {
    std::vector<std::uint8_t> mask;       ///< 1 for each point of the person
    std::size_t count = 0;                ///< of the person's points
    float height_m = 0.0f;                ///< along up
    std::optional<geometry::Plane> floor; ///< or the top of the podium that the person stands on
    std::string trouble;                  ///< why nobody was found; empty when somebody was
};

/// The person among points (world, metres): what is left above the floor and off large flat walls
/// falls into pieces; the piece of human size with most points is the person, with smaller pieces
/// close by. `up`: unit.
[[nodiscard]] FoundPerson find_person(std::span<const Vec3f> points, const Vec3f& up,
                                      const std::optional<geometry::Plane>& floor);

struct ObservedPerson {
    std::vector<Observation> observations; ///< one for each view that sees the person
    std::optional<geometry::Plane> floor;
    float height_m = 0.0f;
    std::string trouble; ///< as FoundPerson's
};

/// The person in views of one instant, whose cameras stand in one world with +Y up.
[[nodiscard]] ObservedPerson observe_person(std::span<const std::shared_ptr<DepthView>> views,
                                            std::size_t instant);

} // namespace toile::scape_fit
