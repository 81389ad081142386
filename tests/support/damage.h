// Deterministic damage to good files: whatever comes out, a reader reads it or throws an Error of
// one line. Anything else (crash, other exception, endless work) fails.
#pragma once

#include "core/bytes.h"
#include "core/log.h"
#include "core/random.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

namespace toile::test {

using Bytes = std::vector<std::uint8_t>;

inline constexpr int kRounds = 400; // per kind of file

/// Bits flipped, bytes replaced, the end cut off, pieces repeated.
inline Bytes damaged(const Bytes& good, Random& random) {
    Bytes bytes = good;
    const auto place = [&] { return static_cast<std::size_t>(random.next() % bytes.size()); };
    constexpr std::uint8_t kValues[] = {0, 1, 0x7f, 0x80, 0xff, '-', '9', '"', '}', '\n'};
    const std::uint64_t times = 1 + random.next() % 4;
    for (std::uint64_t i = 0; i < times && !bytes.empty(); ++i) {
        const std::size_t at = place();
        switch (random.next() % 6) {
        case 0:
            bytes[at] ^= static_cast<std::uint8_t>(1u << (random.next() % 8));
            break;
        case 1:
            bytes[at] = kValues[random.next() % std::size(kValues)];
            break;
        case 2:
            bytes.resize(at);
            break;
        case 3: // four bytes at once: counts and offsets of binary files
            for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k)
                bytes[k] = kValues[random.next() % 5];
            break;
        case 4: { // a piece repeated
            const std::size_t length = std::min<std::size_t>(bytes.size() - at, 64);
            const Bytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                              bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), piece.begin(),
                         piece.end());
            break;
        }
        default: // a digit changed, where one stands near
            for (std::size_t k = at; k < bytes.size(); ++k)
                if (bytes[k] >= '0' && bytes[k] <= '9') {
                    bytes[k] = static_cast<std::uint8_t>('0' + random.next() % 10);
                    break;
                }
        }
    }
    return bytes;
}

/// Damages `file` in `rounds` ways and has it read each time; puts the good bytes back. Returns how
/// many of the damaged files were refused.
inline int torture(const std::filesystem::path& file, const std::function<void()>& read,
                   int rounds = kRounds) {
    log::set_level(log::Level::error);
    const Bytes good = read_bytes(file, 1u << 24);
    EXPECT_NO_THROW(read());
    Random random(1234);
    int refused = 0;
    for (int round = 0; round < rounds; ++round) {
        write_bytes(file, damaged(good, random));
        try {
            read();
        } catch (const Error& e) {
            ++refused;
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
        } catch (const std::exception& e) {
            ADD_FAILURE() << "round " << round << ": not an Error: " << e.what();
        }
    }
    log::set_level(log::Level::info);
    write_bytes(file, good);
    return refused;
}

} // namespace toile::test
