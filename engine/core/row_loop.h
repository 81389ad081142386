// Loops over rows: on the host's threads in a plugin, serial in small programs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

namespace toile {

/// Calls body(begin, end) over ranges that cover [0, count) and depend on count and grain only.
using RowLoop = std::function<void(std::uint32_t count, std::uint32_t grain,
                                   const std::function<void(std::uint32_t, std::uint32_t)>& body)>;

inline void serial_rows(std::uint32_t count, std::uint32_t,
                        const std::function<void(std::uint32_t, std::uint32_t)>& body) {
    body(0, count);
}

} // namespace toile
