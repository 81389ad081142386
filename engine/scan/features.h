// Points of a coloured depth picture that are found again from elsewhere: SIFT (Lowe 2004) in the
// colours, with a place in space from the depth (P1 2.2).
#pragma once

#include "scan/depth_view.h"

#include <span>

namespace toile::scan {

struct FeatureOptions {
    double contrast = 0.006;  ///< least difference of a point from its surroundings, of [0, 1]
    double edge_ratio = 10.0; ///< most ratio of the bends: beyond it is a line and no point
    std::size_t most = 2000;  ///< points that are kept, strongest first
};

struct Feature {
    float x = 0, y = 0;             ///< pixels of the view's window
    float scale = 0;                ///< pixels
    float angle = 0;                ///< of the strongest slope, radians
    Vec3f point = Vec3f::Zero();    ///< camera frame, metres
    std::array<float, 128> full{};  ///< 4 x 4 fields x 8 directions, unit length
    std::array<float, 12> simple{}; ///< P1's: 12 numbers, unit length; see `describe_simply`
};

/// Which descriptors are made; the other one stays zero.
enum class Descriptor : std::uint8_t { invalid, full, simple };

/// Points of the subject that have a depth. Without colours there are none.
[[nodiscard]] std::vector<Feature> find_features(const DepthView& view, Descriptor descriptor,
                                                 const FeatureOptions& options);

/// Grey picture in [0, 1] (linear in sRGB), as features see it.
struct Grey {
    int width = 0, height = 0;
    std::vector<float> values;

    [[nodiscard]] float at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Of any grey picture: points without a place in space. `usable` (pixels), or empty for all.
[[nodiscard]] std::vector<Feature> find_features(const Grey& picture,
                                                 std::span<const std::uint8_t> usable,
                                                 Descriptor descriptor,
                                                 const FeatureOptions& options);

/// A pair of features that look alike: numbers in the two lists.
struct Match {
    std::uint32_t a = 0, b = 0;
};

/// For each of `a` the nearest of `b` when the second nearest is clearly farther (`ratio` of the
/// distances, Lowe 2004), and the same the other way round.
[[nodiscard]] std::vector<Match> match(std::span<const Feature> a, std::span<const Feature> b,
                                       Descriptor descriptor, double ratio);

} // namespace toile::scan
