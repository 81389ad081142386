#include "apps/fit_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::apps {
namespace {

// Brown, white, blue (ColorBrewer's PuOr and RdBu, mixed): touching is warm, roomy is cool.
constexpr std::array<Color, 7> kEase{{{{166, 76, 6}},
                                      {{224, 130, 20}},
                                      {{253, 184, 99}},
                                      {{254, 232, 205}},
                                      {{198, 219, 239}},
                                      {{107, 174, 214}},
                                      {{33, 102, 172}}}};
// Pale yellow to dark brown (ColorBrewer's YlOrBr).
constexpr std::array<Color, 6> kStrain{{{{247, 244, 234}},
                                        {{254, 227, 145}},
                                        {{254, 178, 76}},
                                        {{236, 112, 20}},
                                        {{190, 66, 3}},
                                        {{102, 37, 6}}}};

const FitScale kEaseScale{"Room", "cloth to skin", "touches", "and more", 0.06f, 100.0f, "cm", 7,
                          kEase};
const FitScale kStrainScale{"Stretch", "of the cloth", "at rest", "and more", 0.10f, 100.0f, "%",
                            6,         kStrain};

} // namespace

const FitScale& FitScale::of(FitMapKind kind) noexcept {
    return kind == FitMapKind::strain ? kStrainScale : kEaseScale;
}

Color FitScale::color(float share) const noexcept {
    const auto last = static_cast<float>(colors.size() - 1);
    const float at = std::clamp(share, 0.0f, 1.0f) * last;
    const auto low = static_cast<std::size_t>(std::min(std::floor(at), last - 1.0f));
    const float rest = at - static_cast<float>(low);
    Color out{};
    for (std::size_t c = 0; c < out.size(); ++c)
        out[c] = static_cast<std::uint8_t>(
            std::lround((1.0f - rest) * static_cast<float>(colors[low][c]) +
                        rest * static_cast<float>(colors[low + 1][c])));
    return out;
}

} // namespace toile::apps
