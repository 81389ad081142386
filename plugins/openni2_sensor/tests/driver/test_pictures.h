// What the cameras of the test driver show.
#pragma once

#include <array>
#include <cstdint>

namespace toile::openni2_sensor::test {

inline constexpr int kWidth = 64, kHeight = 48, kFramesPerSecond = 60;
inline constexpr float kAcross = 1.0f, kUp = 0.77f; // field of view, radians
inline constexpr std::array<const char*, 2> kUris{"toile-test:first", "toile-test:second"};

/// Millimetres; some pixels have no reading.
inline std::uint16_t depth_at(int x, int y, int number) {
    if ((x + 3 * y + number) % 17 == 0) return 0;
    return static_cast<std::uint16_t>(500 + 40 * x + 3 * y + number % 100);
}
inline std::uint8_t color_at(int x, int y, int channel, int number) {
    return static_cast<std::uint8_t>(3 * x + 5 * y + 80 * channel + number % 7);
}

} // namespace toile::openni2_sensor::test
