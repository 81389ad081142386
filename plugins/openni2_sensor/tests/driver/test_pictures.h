// What the cameras of the test driver show, and what tests may have them do wrong.
#pragma once

#include <array>
#include <cstdint>

namespace toile::openni2_sensor::test {

inline constexpr int kWidth = 64, kHeight = 48, kFramesPerSecond = 60;
inline constexpr float kAcross = 1.0f, kUp = 0.77f; // field of view, radians
inline constexpr int kLargestDepth = 10000;         // millimetres
inline constexpr std::array<const char*, 2> kUris{"toile-test:first", "toile-test:second"};

/// Of the next depth picture, unless said otherwise.
enum class Fault : int {
    none,
    all_zero,
    all_saturated,      ///< at the largest value
    smaller,            ///< of half the size
    larger,             ///< of twice the size
    smaller_from_now,   ///< until `none` is wished
    other_format,       ///< says tenths of millimetres
    twice,              ///< sent a second time
    late,               ///< the one before is sent again after it
    ten_dropped,        ///< the next ten are not sent
    clock_back,         ///< by ten seconds, from now on
    clock_ahead,        ///< by ten minutes, from now on
    clock_stands_still, ///< until `none` is wished
    counts_anew,        ///< from 1, from now on
    count_ahead,        ///< by a million, from now on
};

/// Millimetres; some pixels have no reading.
inline std::uint16_t depth_at(int x, int y, int number) {
    if ((x + 3 * y + number) % 17 == 0) return 0;
    return static_cast<std::uint16_t>(500 + 40 * x + 3 * y + number % 100);
}
inline std::uint8_t color_at(int x, int y, int channel, int number) {
    return static_cast<std::uint8_t>(3 * x + 5 * y + 80 * channel + number % 7);
}

} // namespace toile::openni2_sensor::test
