// The two populations that bodies are drawn from.
#pragma once

#include <array>
#include <cstdint>

namespace toile::body {

enum class Sex : std::uint8_t { invalid, female, male };
inline constexpr std::array<Sex, 2> kSexes = {Sex::female, Sex::male};

[[nodiscard]] constexpr const char* sex_name(Sex sex) {
    return sex == Sex::female ? "female" : "male";
}

} // namespace toile::body
