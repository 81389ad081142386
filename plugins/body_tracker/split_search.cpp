#include "body_tracker/split_search.h"

#include "body_tracker/depth_probe.h"
#include "core/random.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

constexpr std::size_t kThresholds = 31;
constexpr std::int16_t kNever = 32767; // above all values

std::uint64_t fold(std::uint64_t sum, std::uint64_t value) {
    return Random(sum ^ value).next();
}

/// How many of the rising thresholds (31, filled up with kNever) a value reaches.
std::size_t bin(const std::array<std::int16_t, kThresholds>& thresholds, std::int16_t value) {
    std::size_t at = 0;
    for (const std::size_t step : {16u, 8u, 4u, 2u, 1u})
        at += thresholds[at + step - 1] <= value ? step : 0;
    return at;
}

} // namespace

ClassWeights class_weights(const TrainingSet& set, const TrainerOptions& options) {
    std::array<double, kMaxClasses> counts{};
    for (const TrainingSet::Sample& s : set.samples())
        counts[s.label] += 1.0;
    const double mean = static_cast<double>(set.samples().size()) / options.class_count;
    ClassWeights out{};
    for (std::size_t c = 0; c < out.size(); ++c)
        if (counts[c] > 0.0)
            out[c] = static_cast<std::uint32_t>(std::clamp(
                std::rint(64.0 * std::pow(mean / counts[c], options.balance)), 1.0, 1024.0));
    return out;
}

// Cubes: near places are asked more often than far ones.
DepthFeature SplitSearch::draw(std::size_t tree, std::uint32_t node, int candidate) const {
    Random random(
        fold(fold(fold(options_.seed, tree), node), static_cast<std::uint64_t>(candidate)));
    const auto offset = [&] {
        const double u = random.uniform(-1.0, 1.0);
        return static_cast<std::int16_t>(u * u * u * options_.reach_mm);
    };
    DepthFeature feature;
    feature.ax = offset();
    feature.ay = offset();
    if (random.next() % 2 == 0) return feature;
    feature.bx = offset();
    feature.by = offset();
    return feature;
}

// Sample by sample, so that a frame is fetched once for all candidates.
void SplitSearch::evaluate(std::span<const std::uint32_t> samples,
                           std::span<const DepthFeature> features, Scratch& scratch) const {
    const std::size_t used = std::min<std::size_t>(samples.size(), options_.split_samples);
    scratch.classes.resize(used);
    scratch.all = {};
    scratch.values.resize(used * features.size());
    for (std::size_t i = 0; i < used; ++i) {
        const auto& s = set_.samples()[samples[i * samples.size() / used]];
        const DepthView view = set_.frame(s.frame);
        const std::int64_t scale = pixel_scale(view, view.mm[s.y * view.width + s.x]);
        scratch.classes[i] = static_cast<std::uint8_t>(s.label);
        scratch.all.add(s.label, weights_[s.label]);
        for (std::size_t f = 0; f < features.size(); ++f)
            scratch.values[f * used + i] = static_cast<std::int16_t>(
                std::clamp(difference(features[f], view, s.x, s.y, scale), -32766, 32766));
    }
}

// Thresholds are values of evenly taken samples, which follow the distribution of all.
Split SplitSearch::best_threshold(std::span<const std::int16_t> values, Scratch& scratch) const {
    std::array<std::int16_t, kThresholds> thresholds{};
    const std::size_t tried =
        std::min<std::size_t>(static_cast<std::size_t>(options_.thresholds), values.size());
    for (std::size_t t = 0; t < tried; ++t)
        thresholds[t] = values[(2 * t + 1) * values.size() / (2 * tried)];
    std::sort(thresholds.begin(), thresholds.begin() + static_cast<std::ptrdiff_t>(tried));
    std::fill(thresholds.begin() + static_cast<std::ptrdiff_t>(tried), thresholds.end(), kNever);

    // Samples by bin: a counting sort.
    std::array<std::size_t, kThresholds + 2> first{};
    scratch.bins.resize(values.size());
    scratch.sorted.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t b = bin(thresholds, values[i]);
        scratch.bins[i] = static_cast<std::uint8_t>(b);
        ++first[b + 1];
    }
    for (std::size_t b = 1; b < first.size(); ++b)
        first[b] += first[b - 1];
    for (std::size_t i = 0; i < values.size(); ++i) // first[b] ends as the end of bin b
        scratch.sorted[first[scratch.bins[i]]++] = scratch.classes[i];
    SplitSide below, above = scratch.all;
    const double before = above.purity();
    Split best;
    for (std::size_t t = 0, at = 0; t < tried; ++t) {
        for (; at < first[t]; ++at) {
            const std::size_t c = scratch.sorted[at];
            below.add(c, weights_[c]);
            above.add(c, -static_cast<std::int64_t>(weights_[c]));
        }
        const double gain = below.purity() + above.purity() - before;
        // More than rounding: a split that leaves one side empty gains nothing.
        if (gain > 1e-9 * before && gain > best.gain) best = {gain, {}, thresholds[t]};
    }
    return best;
}

Split SplitSearch::best(std::size_t tree, std::uint32_t node,
                        std::span<const std::uint32_t> samples, int first, Scratch& scratch) const {
    std::array<DepthFeature, kBlock> drawn;
    const int count = std::min(kBlock, options_.candidates - first);
    for (int c = 0; c < count; ++c)
        drawn[static_cast<std::size_t>(c)] = draw(tree, node, first + c);
    const auto features = std::span(drawn).first(static_cast<std::size_t>(count));
    evaluate(samples, features, scratch);
    const std::size_t used = scratch.classes.size();
    Split best;
    for (std::size_t f = 0; f < features.size(); ++f) {
        Split split = best_threshold(std::span(scratch.values).subspan(f * used, used), scratch);
        split.feature = features[f];
        if (split.gain > best.gain) best = split;
    }
    best.gain *= static_cast<double>(samples.size()) / static_cast<double>(used);
    return best;
}

} // namespace toile::body_tracker
