// The one log of the process: lines on standard error. The only global.
#pragma once

#include <string_view>

namespace toile::log {

enum class Level { debug = 1, info, warning, error };

/// Lines below this level are dropped; `info` at start. [any thread]
void set_level(Level level);

/// Writes one line. [any thread]
void write(Level level, std::string_view text);

inline void debug(std::string_view text) {
    write(Level::debug, text);
}
inline void info(std::string_view text) {
    write(Level::info, text);
}
inline void warning(std::string_view text) {
    write(Level::warning, text);
}
inline void error(std::string_view text) {
    write(Level::error, text);
}

} // namespace toile::log
