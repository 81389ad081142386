// The legs of an unknown upright body: where they part, knees, ankles, feet.
#pragma once

#include "body/profile.h"
#include "body/sections.h"

namespace toile::body {

/// One leg, by its level sections from the crotch down.
struct FoundLeg {
    std::vector<Outline> sections; ///< falling
    std::vector<float> heights;    ///< of the sections
    float knee = 0.0f;             ///< heights, world
    float lower_knee = 0.0f;
    float thinnest = 0.0f; ///< above the ankle
    float ankle = 0.0f;
    double knee_trust = 0.0;
    Vec2f toe = Vec2f::Zero(); ///< x, z of the foot's farthest point

    [[nodiscard]] const Outline& near(float y) const; ///< the section nearest to a height
};

struct FoundLegs {
    Outline seat; ///< the trunk just above the crotch
    Vec3f crotch = Vec3f::Zero();
    std::array<FoundLeg, 2> legs; ///< the first has the larger x
};

/// \throw Error when the legs cannot be told apart
[[nodiscard]] FoundLegs find_legs(const Sections& sections, const Vec3f& middle);

} // namespace toile::body
