// A value along a body's height or a limb's length, and what tailors feel for in it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace toile::body {

/// Evenly or unevenly sampled; `at` rises or falls all along.
struct Profile {
    std::vector<float> at, value;

    void add(float position, float v) {
        at.push_back(position);
        value.push_back(v);
    }
    [[nodiscard]] std::size_t size() const { return at.size(); }
    /// The samples from position a to position b, in their order.
    [[nodiscard]] Profile between(float a, float b) const;

    /// Index of the extreme value. \throw Error when empty
    [[nodiscard]] std::size_t largest() const;
    [[nodiscard]] std::size_t smallest() const;
    /// Index of the first peak whose value falls again by `drop` of itself behind it; nothing when
    /// there is none.
    [[nodiscard]] std::optional<std::size_t> first_peak(float drop) const;
    /// The same for a hollow that rises again.
    [[nodiscard]] std::optional<std::size_t> first_hollow(float rise) const;
    /// Index of the sample farthest above the chord from the first sample to the last.
    [[nodiscard]] std::size_t corner_above() const;
    [[nodiscard]] std::size_t corner_below() const;
    /// Index where the value changes fastest upwards along `at`, over `window` samples each way.
    [[nodiscard]] std::size_t steepest(std::size_t window) const;
};

} // namespace toile::body
