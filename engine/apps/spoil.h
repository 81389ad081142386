// A picture drawn wrongly on purpose, so that tests can see that the comparison of pictures
// notices.
#pragma once

#include <string>

namespace toile::apps {

enum class Spoil {
    none,
    shift,    ///< garments are drawn 1 cm towards the body's left
    shadows,  ///< nothing casts a shadow
    body,     ///< the body neither is seen nor hides what is behind it
    occlusion ///< of a camera's picture: nothing real hides cloth
};

/// "" is none. \throw UsageError when there is no such way
[[nodiscard]] Spoil spoil_from_name(const std::string& name);

} // namespace toile::apps
