// MakeHuman's modifier families that the body space is never trained on: people made with them
// test whether it fits shapes that its generator could not have taught it.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace toile::body {

/// Beginnings of target names, as MakeHumanData::target takes them.
inline constexpr std::array<std::string_view, 3> kHeldOutModifiers = {
    "bodyshapes/", // whole-body types: apple, hourglass, lean column ...
    "asym/",       // left and right differ: trunk, breasts, face
    "breast/",     // size, firmness, height and distance of the breasts
};

/// Is a target kept for testing? Training must draw none of which this is true.
[[nodiscard]] constexpr bool held_out(std::string_view target) {
    return std::any_of(kHeldOutModifiers.begin(), kHeldOutModifiers.end(),
                       [&](std::string_view family) { return target.starts_with(family); });
}

} // namespace toile::body
