// What an operator's monitoring reads: a text file in Prometheus' format.
#pragma once

#include "apps/kiosk/screens.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace toile::apps::kiosk {

/// Things that went wrong and were gone around.
enum class Fault { invalid, camera, plugin, garment, disk, clock, picture, crash };
inline constexpr std::size_t kFaultCount = 8;
[[nodiscard]] const char* fault_name(Fault fault);

/// Counts only; nothing of a person.
struct Metrics {
    std::uint64_t frames = 0;
    std::uint64_t dropped = 0;
    std::uint64_t visits = 0; ///< consent was given
    std::uint64_t declined = 0;
    std::uint64_t garments = 0; ///< put on
    std::uint64_t snapshots = 0;
    std::uint64_t restarts = 0; ///< of the mirror by its watchdog
    std::array<std::uint64_t, kFaultCount> faults{};
    double frame_p95_s = 0.0;   ///< wall
    double latency_p95_s = 0.0; ///< capture to picture
    double picture_scale = 1.0; ///< share of the full resolution that is drawn
    bool camera_up = false;
    ScreenName screen = ScreenName::invalid;

    void count(Fault fault) { ++faults[static_cast<std::size_t>(fault)]; }
};

/// Each metric with its HELP and TYPE lines; ends with a newline.
[[nodiscard]] std::string prometheus_text(const Metrics& metrics);

} // namespace toile::apps::kiosk
