// Random numbers with an address instead of a state: the same pixel of the same frame of the same
// camera draws the same number, in whatever order and on whatever thread it asks.
#pragma once

#include <array>
#include <cstdint>

namespace toile::simulated_sensor {

/// What a number is drawn for; draws for different purposes are independent.
enum class Draw : std::uint8_t {
    invalid,
    depth,   ///< axial noise
    shift_x, ///< lateral noise, pixels along x
    shift_y, ///< the same along y
    ragged,  ///< readings lost at silhouettes
    grazing, ///< readings lost on surfaces seen edge on
    hair,    ///< readings lost in hair
    red,     ///< colour noise
    green,
    blue,
    systematic, ///< errors that stay the same over a recording
    holes,      ///< patches without readings
};

/// Value of a standard normal variable at the middle of one of 2^14 equally likely intervals
/// (selected by the top bits); the table has mean 0 and variance 1 exactly.
[[nodiscard]] float normal_quantile(std::uint64_t bits) noexcept;

/// Every number of one camera in one frame. Coordinates may lie outside the picture.
class PixelRandom {
  public:
    PixelRandom(std::uint64_t seed, std::uint32_t camera, std::uint32_t frame) noexcept
        : key_(mix(mix(mix(seed) ^ camera) ^ frame)) {}

    [[nodiscard]] std::uint64_t bits(Draw draw, int x, int y) const noexcept {
        const auto place = static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
                           static_cast<std::uint32_t>(y);
        return mix(mix(key_ + static_cast<std::uint64_t>(draw) * 0x9e3779b97f4a7c15ull) ^ place);
    }
    /// Uniform in [0, 1).
    [[nodiscard]] float uniform(Draw draw, int x, int y) const noexcept {
        return static_cast<float>(bits(draw, x, y) >> 40) * 0x1.0p-24f;
    }
    /// Standard normal, independent of its neighbours.
    [[nodiscard]] float normal(Draw draw, int x, int y) const noexcept {
        return normal_quantile(bits(draw, x, y));
    }
    /// Standard normal, correlated with its neighbours over a few pixels: white noise under a
    /// binomial kernel (1 4 6 4 1), so 0.8 with the next pixel and 0.4 with the one after.
    [[nodiscard]] float smooth_normal(Draw draw, int x, int y) const noexcept;

  private:
    /// SplitMix64's finaliser: every bit of the result depends on every bit of the argument.
    [[nodiscard]] static std::uint64_t mix(std::uint64_t z) noexcept {
        z += 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }

    std::uint64_t key_;
};

/// (1 4 6 4 1) scaled so that filtered white noise keeps its variance.
inline constexpr std::array<float, 5> kSmoothKernel = {0.11952286f, 0.47809145f, 0.71713716f,
                                                       0.47809145f, 0.11952286f};

} // namespace toile::simulated_sensor
