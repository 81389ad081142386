#include "scape_fit/cloth_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::scape_fit {
namespace {

constexpr std::size_t kPatches = 120; // about a hand's breadth each
constexpr float kBareBy = 1.5f;       // more of skin's colour than of another

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
      bare_(level.mean.size(), 0), gaps_(kPatches, 0.0f),
      weights_(kPatches, options.unknown_weight) {}

void ClothGaps::find_bare(std::span<const Association> associations) {
    std::vector<float> skin(level_.mean.size(), 0.0f), cloth(level_.mean.size(), 0.0f);
    for (const Association& one : associations)
        for (const VertexPair& pair : one.pairs) {
            skin[pair.vertex] += pair.bare;
            cloth[pair.vertex] += pair.covered;
        }
    // A vertex and those beside it: single pixels are taken for the other.
    const auto spread = [&](const std::vector<float>& votes) {
        std::vector<float> out = votes;
        for (const Triangle& t : level_.triangles)
            for (std::size_t i = 0; i < 3; ++i)
                out[t[i]] += 0.5f * (votes[t[(i + 1) % 3]] + votes[t[(i + 2) % 3]]);
        return out;
    };
    skin = spread(skin);
    cloth = spread(cloth);
    for (std::size_t v = 0; v < bare_.size(); ++v)
        bare_[v] = skin[v] > kBareBy * cloth[v] ? 1 : 0;
}

void ClothGaps::learn(std::span<const Association> associations) {
    std::vector<double> sums(kPatches, 0.0), areas(kPatches, 1e-12);
    for (const Association& one : associations)
        for (const VertexPair& pair : one.pairs) {
            if (pair.kind != PairKind::skin || bare_[pair.vertex] != 0) continue;
            sums[patch_of_[pair.vertex]] +=
                static_cast<double>(pair.observed * std::max(-pair.distance, 0.0f));
            areas[patch_of_[pair.vertex]] += static_cast<double>(pair.observed);
        }
    for (std::size_t p = 0; p < kPatches; ++p) {
        gaps_[p] = std::max(static_cast<float>(sums[p] / areas[p]) - options_.noise_m, 0.0f);
        weights_[p] = 1.0f / (1.0f + gaps_[p] / options_.half_weight_m);
    }
}

float ClothGaps::weight(std::uint32_t vertex, float distance) const {
    if (level_.clothed[vertex] == 0 || bare_[vertex] != 0 || distance >= 0.0f) return 1.0f;
    return weights_[patch_of_[vertex]];
}

} // namespace toile::scape_fit
