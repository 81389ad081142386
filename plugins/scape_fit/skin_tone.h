// What a person's skin looks like, learned from the face; tells bare skin from cloth.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <optional>
#include <span>

namespace toile::scape_fit {

/// Natural logarithms of red by green and of blue by green, linear light: what is left of a colour
/// when light and shade are taken away. NaN where it is too dark or too bright to tell. `srgb`:
/// (3) of 0 .. 255.
[[nodiscard]] Vec2f hue_of(const std::uint8_t* srgb);

class SkinTone {
  public:
    /// From what was seen of a face; NaNs are left out. Nothing where too little was seen, where
    /// it is of many colours, or of one that no skin has in white light (unless `of_mannequins`).
    [[nodiscard]] static std::optional<SkinTone> learn(std::span<const Vec2f> face,
                                                       bool of_mannequins = false);

    /// \pre `hue` is finite
    [[nodiscard]] bool like(const Vec2f& hue) const;
    [[nodiscard]] const Vec2f& hue() const { return hue_; }

  private:
    Vec2f hue_ = Vec2f::Zero();
    float reach_ = 0.0f; ///< farther hues are another colour
};

} // namespace toile::scape_fit
