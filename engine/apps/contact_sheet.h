// Several pictures as one.
#pragma once

#include "imaging/image.h"

#include <string>
#include <utility>
#include <vector>

namespace toile::apps {

/// Pictures of equal height next to each other. \throw Error when they differ or there are none
[[nodiscard]] imaging::Image side_by_side(const std::vector<imaging::Image>& pictures);

/// A picture at another height, its shape kept. \throw Error
[[nodiscard]] imaging::Image shrunk(const imaging::Image& picture, int height);

/// "480x640" -> width, height. \throw UsageError
[[nodiscard]] std::pair<int, int> size_from_text(const std::string& text);

} // namespace toile::apps
