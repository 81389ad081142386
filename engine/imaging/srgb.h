// sRGB's curve (IEC 61966-2-1).
#pragma once

#include <cmath>

namespace toile::imaging {

/// Both within [0, 1].
inline float linear_from_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}
inline float srgb_from_linear(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

} // namespace toile::imaging
