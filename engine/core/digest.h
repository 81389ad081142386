// A short fingerprint of bytes: equal input, equal digest; no protection against forgery.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace toile {

/// FNV-1a, 64 bits.
class Digest {
  public:
    void add(std::span<const std::uint8_t> bytes) noexcept {
        for (const std::uint8_t byte : bytes)
            value_ = (value_ ^ byte) * 0x100000001b3ull;
    }
    /// A text and its end, so that "ab" + "c" differs from "a" + "bc".
    void add(std::string_view text) noexcept {
        for (const char c : text)
            value_ = (value_ ^ static_cast<std::uint8_t>(c)) * 0x100000001b3ull;
        value_ = (value_ ^ 0xffu) * 0x100000001b3ull;
    }

    [[nodiscard]] std::uint64_t value() const noexcept { return value_; }
    /// 16 hexadecimal digits.
    [[nodiscard]] std::string hex() const {
        std::string out(16, '0');
        for (int i = 0; i < 16; ++i)
            out[std::size_t(i)] = "0123456789abcdef"[(value_ >> (60 - 4 * i)) & 15u];
        return out;
    }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325ull;
};

} // namespace toile
