// The best question for one node of a growing tree.
#pragma once

#include "body_tracker/forest_trainer.h"

#include <array>

namespace toile::body_tracker {

/// One question and how much purer it leaves a node's samples; gain 0 = none.
struct Split {
    double gain = 0.0; ///< of all samples of the node, each by its class's weight
    DepthFeature feature;
    int threshold = 0;
};

/// Weights of the classes on one side of a threshold, and the sum of their squares.
class SplitSide {
  public:
    void add(std::size_t c, std::int64_t weight) {
        squares_ += weight * (2 * sums_[c] + weight);
        sums_[c] += weight;
        total_ += weight;
    }
    /// Sum over classes of n_c^2 / n: the larger, the purer.
    [[nodiscard]] double purity() const {
        return total_ > 0 ? static_cast<double>(squares_) / static_cast<double>(total_) : 0.0;
    }

  private:
    std::array<std::int64_t, kMaxClasses> sums_{};
    std::int64_t squares_ = 0, total_ = 0;
};

/// Whole numbers, so that sums are exact in any order.
using ClassWeights = std::array<std::uint32_t, kMaxClasses>;
/// 64 for a class of mean size. \see TrainerOptions::balance
[[nodiscard]] ClassWeights class_weights(const TrainingSet& set, const TrainerOptions& options);

/// Tries features drawn from the seed, tree, node and number: the same whoever asks. Calls are
/// const and may run side by side, each with its own scratch.
class SplitSearch {
  public:
    static constexpr int kBlock = 32; ///< candidates tried together, sample by sample

    struct Scratch {
        std::vector<std::int16_t> values;  // (kBlock x samples)
        std::vector<std::uint8_t> classes; // (samples)
        SplitSide all;                     // of the samples
        std::vector<std::uint8_t> bins;    // (samples) how many thresholds a value reaches
        std::vector<std::uint8_t> sorted;  // (samples) classes by rising bin
    };

    SplitSearch(const TrainingSet& set, const TrainerOptions& options)
        : set_(set), options_(options), weights_(class_weights(set, options)) {}

    /// Best of the candidates `first` to at most `first` + kBlock - 1; equals go to the first.
    [[nodiscard]] Split best(std::size_t tree, std::uint32_t node,
                             std::span<const std::uint32_t> samples, int first,
                             Scratch& scratch) const;
    [[nodiscard]] const ClassWeights& weights() const { return weights_; }

  private:
    [[nodiscard]] DepthFeature draw(std::size_t tree, std::uint32_t node, int candidate) const;
    void evaluate(std::span<const std::uint32_t> samples, std::span<const DepthFeature> features,
                  Scratch& scratch) const;
    [[nodiscard]] Split best_threshold(std::span<const std::int16_t> values,
                                       Scratch& scratch) const;

    const TrainingSet& set_;
    const TrainerOptions& options_;
    ClassWeights weights_;
};

} // namespace toile::body_tracker
