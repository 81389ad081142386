// How far cloth stands off the skin, patch by patch of the body, as a fit learns it.
#pragma once

#include "scape_fit/association_types.h"
#include "scape_fit/fit_model.h"

#include <span>

namespace toile::scape_fit {

struct ClothGapOptions {
    float half_weight_m =
        5e-5f;               ///< gap, beyond noise, at which cloth counts half of what skin does
    float noise_m = 0.0045f; ///< mean gap of bare skin
    float unknown_weight = 0.03f; ///< of what is outside, before gaps are learned
};

/// Where what is seen has the colour of skin, it is skin. Elsewhere a patch's mean gap over all
/// instants tells how far its cloth is believed: gaps are taken to be exponentially distributed, so
/// that cloth draws the body with the same small force wherever it hangs, fully where it lies on
/// the skin; skin is never outside of cloth (Balan and Black 2008; P5 4.3 takes the least gap of
/// each point instead, which noise biases).
class ClothGaps {
  public:
    ClothGaps(const FitLevel& level, const ClothGapOptions& options);

    /// Learns from colours which vertices are bare, from the pairs of all instants.
    void find_bare(std::span<const Association> associations);
    /// Learns the mean gaps of the others.
    void learn(std::span<const Association> associations);

    /// Factor of a pair's weight, (0, 1]. `distance`: model minus observed, metres; the cloth is
    /// outside where it is below 0.
    [[nodiscard]] float weight(std::uint32_t vertex, float distance) const;
    /// Mean gap around a vertex beyond noise, metres.
    [[nodiscard]] float gap(std::uint32_t vertex) const { return gaps_[patch_of_[vertex]]; }
    [[nodiscard]] bool bare(std::uint32_t vertex) const { return bare_[vertex] != 0; }

  private:
    const FitLevel& level_;
    ClothGapOptions options_;
    std::vector<std::uint16_t> patch_of_; ///< (n)
    std::vector<std::uint8_t> bare_;      ///< (n)
    std::vector<float> gaps_;             ///< of each patch, metres
    std::vector<float> weights_;          ///< of its cloth
};

} // namespace toile::scape_fit
