// What associating the model with observations gives.
#pragma once

#include "core/types.h"

#include <cstdint>
#include <vector>

namespace toile::scape_fit {

/// What a pair comes from.
enum class PairKind : std::uint8_t {
    skin,    ///< a point of the surface
    outline, ///< where a camera sees the person end
    empty,   ///< a place of the model where there is nothing
    floor,   ///< beneath a foot
};

/// Pairs summed up at a vertex of the level: their weight, mean distance and mean place.
struct VertexPair {
    std::uint32_t vertex = 0;
    Vec3f normal = Vec3f::Zero();      ///< along which the distance counts, unit
    Vec3f place = Vec3f::Zero();       ///< observed, world
    float distance = 0.0f;             ///< model minus observed, metres
    float weight = 0.0f;               ///< m^2 of surface
    float observed = 0.0f;             ///< the same before cloth lowers it
    float bare = 0.0f, covered = 0.0f; ///< of `observed`: what looks like skin, and like cloth
    PairKind kind = PairKind::skin;
};

struct Association {
    std::vector<VertexPair> pairs;
    double paired_area = 0.0;   ///< m^2 of points that have a partner
    double observed_area = 0.0; ///< m^2 of all points
    double squares = 0.0;       ///< m^4: area times squared distance of the pairs, not weighted
};

/// Robust weight of a distance, 1 at 0 (Geman and McClure).
inline float geman_mcclure(float distance, float scale) {
    const float s = scale * scale;
    const float root = s / (s + distance * distance);
    return root * root;
}

} // namespace toile::scape_fit
