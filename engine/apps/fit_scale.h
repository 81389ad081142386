// Scales of fit maps: their ends, words and colours. Colours differ in lightness as well as in hue,
// so that they can be told apart without seeing red and green.
#pragma once

#include "apps/fit_map.h"
#include "apps/label.h"

#include <span>

namespace toile::apps {

struct FitScale {
    const char* title;
    const char* subtitle;
    const char* lowest;            ///< what the low end means
    const char* highest;           ///< what the high end means
    float most;                    ///< at the high end; metres, or share
    float in_print;                ///< of a unit: 100 for cm or %
    const char* unit;              ///< "cm"
    int ticks;                     ///< between the ends, both counted
    std::span<const Color> colors; ///< evenly spaced, low to high; sRGB

    /// `kind` must not be none.
    [[nodiscard]] static const FitScale& of(FitMapKind kind) noexcept;
    /// At a share of the scale; outside of [0, 1] that of the end.
    [[nodiscard]] Color color(float share) const noexcept;
};

} // namespace toile::apps
