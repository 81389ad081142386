// How far cloth stands off the skin, patch by patch of the body, as a fit learns it.
#pragma once

#include "scape_fit/association_types.h"
#include "scape_fit/fit_model.h"

#include <span>

namespace toile::scape_fit {

struct ClothGapOptions {
    /// Gaps of one garment go together: as so many patches of cloth as say what one of independent
    /// gaps would.
    float alike = 20.0f;
    float noise_m = 0.0045f;      ///< mean gap of bare skin
    float unknown_weight = 0.03f; ///< of what is outside, before gaps are learned
};

/// A patch's mean gap over all instants tells how far its cloth can be believed: where it is tight
/// it draws the body to it, where it is loose it hardly does, and skin is never outside of cloth
/// (Balan and Black 2008; P5 4.3 takes the least gap of each point instead, which noise biases).
class ClothGaps {
  public:
    ClothGaps(const FitLevel& level, const ClothGapOptions& options);

    /// Learns the mean gaps from the pairs of all instants.
    void learn(std::span<const Association> associations);

    /// Factor of a pair's weight, (0, 1]. `distance`: model minus observed, metres; the cloth is
    /// outside where it is below 0.
    [[nodiscard]] float weight(std::uint32_t vertex, float distance) const;
    /// Mean gap around a vertex beyond noise, metres.
    [[nodiscard]] float gap(std::uint32_t vertex) const { return gaps_[patch_of_[vertex]]; }

  private:
    const FitLevel& level_;
    ClothGapOptions options_;
    std::vector<std::uint16_t> patch_of_; ///< (n)
    std::vector<float> gaps_;             ///< of each patch, metres
    std::vector<float> weights_;          ///< of its cloth
};

} // namespace toile::scape_fit
