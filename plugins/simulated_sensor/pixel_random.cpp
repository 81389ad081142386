#include "simulated_sensor/pixel_random.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace toile::simulated_sensor {
namespace {

constexpr std::size_t kLevels = 1u << 14;

/// x with P(normal < x) = p, for p in (0, 0.5]: Newton's method on the distribution function.
double quantile(double p) {
    double x = -std::sqrt(-2.0 * std::log(2.0 * p)); // beyond the root, so that it is approached
    for (int i = 0; i < 60; ++i) {
        const double below = 0.5 * std::erfc(-x / std::numbers::sqrt2);
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
        const double step = (below - p) / density;
        x -= step;
        if (std::abs(step) < 1e-12) break;
    }
    return x;
}

std::vector<float> make_table() {
    std::vector<double> half(kLevels / 2);
    double variance = 0.0;
    for (std::size_t i = 0; i < half.size(); ++i) {
        half[i] = quantile((static_cast<double>(i) + 0.5) / static_cast<double>(kLevels));
        variance += half[i] * half[i] / static_cast<double>(half.size());
    }
    std::vector<float> table(kLevels);
    for (std::size_t i = 0; i < half.size(); ++i) {
        table[i] = static_cast<float>(half[i] / std::sqrt(variance));
        table[kLevels - 1 - i] = -table[i];
    }
    return table;
}

} // namespace

float normal_quantile(std::uint64_t bits) noexcept {
    static const std::vector<float> table = make_table();
    return table[bits >> 50];
}

float PixelRandom::smooth_normal(Draw draw, int x, int y) const noexcept {
    float sum = 0.0f;
    for (int j = 0; j < 5; ++j) {
        float row = 0.0f;
        for (int i = 0; i < 5; ++i)
            row += kSmoothKernel[static_cast<std::size_t>(i)] * normal(draw, x + i - 2, y + j - 2);
        sum += kSmoothKernel[static_cast<std::size_t>(j)] * row;
    }
    return sum;
}

} // namespace toile::simulated_sensor
