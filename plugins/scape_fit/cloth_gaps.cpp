#include "scape_fit/cloth_gaps.h"

#include "scape_fit/fit_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::scape_fit {
namespace {

constexpr std::size_t kPatches = 120; // about a hand's breadth each

/// Each vertex' nearest of `count` seeds that are spread evenly: the next is the farthest from all.
std::vector<std::uint16_t> spread_patches(std::span<const Vec3f> places, std::size_t count) {
    std::vector<std::uint16_t> out(places.size(), 0);
    std::vector<float> nearest(places.size(), std::numeric_limits<float>::max());
    std::size_t seed = 0;
    for (std::size_t patch = 0; patch < count; ++patch) {
        for (std::size_t v = 0; v < places.size(); ++v) {
            const float squared = (places[v] - places[seed]).squaredNorm();
            if (squared >= nearest[v]) continue;
            nearest[v] = squared;
            out[v] = static_cast<std::uint16_t>(patch);
        }
        seed = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) -
                                        nearest.begin());
    }
    return out;
}

} // namespace

ClothGaps::ClothGaps(const FitLevel& level, const ClothGapOptions& options)
    : level_(level), options_(options),
      patch_of_(spread_patches(level.mean, std::min(kPatches, level.mean.size()))),
      gaps_(kPatches, 0.0f), weights_(kPatches, options.unknown_weight) {}

void ClothGaps::learn(std::span<const Association> associations) {
    std::vector<double> sums(kPatches, 0.0), areas(kPatches, 1e-12);
    for (const Association& one : associations)
        for (const VertexPair& pair : one.pairs) {
            if (pair.kind != PairKind::skin) continue;
            sums[patch_of_[pair.vertex]] +=
                static_cast<double>(pair.observed * std::max(-pair.distance, 0.0f));
            areas[patch_of_[pair.vertex]] += static_cast<double>(pair.observed);
        }
    for (std::size_t p = 0; p < kPatches; ++p) {
        gaps_[p] = std::max(static_cast<float>(sums[p] / areas[p]) - options_.noise_m, 0.0f);
        const float deviations = gaps_[p] / static_cast<float>(kModelDeviation);
        weights_[p] = 1.0f / (1.0f + options_.alike * deviations * deviations);
    }
}

float ClothGaps::weight(std::uint32_t vertex, float distance) const {
    if (level_.clothed[vertex] == 0 || distance >= 0.0f) return 1.0f;
    return weights_[patch_of_[vertex]];
}

} // namespace toile::scape_fit
