// What a run tells about itself: a table for people, and the file of --report.
#pragma once

#include "pipeline/contact_watch.h"
#include "pipeline/stage_clock.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace toile::pipeline {

/// Wall time from a frame's capture, live clock only.
struct Latency {
    double median_ms = 0.0;
    double p95_ms = 0.0;
};

/// Figures of one run; definitions in docs/file_formats.md ("Run report").
struct RunReport {
    std::uint64_t frames = 0;
    std::uint64_t dropped = 0;
    std::map<std::string, Quantiles> stages; ///< CPU
    Quantiles compute;                       ///< CPU, all but drawing
    std::optional<Latency> picture_latency;
    std::optional<Latency> garment_state_latency;
    std::optional<ContactWorst> contact; ///< when it was measured
    std::string positions_digest;        ///< of every garment position of every frame
    std::map<std::string, std::string> versions;
    std::uint64_t seed = 0;
};

/// \throw Error when the file cannot be written
void write_report(const RunReport& report, const std::filesystem::path& file);

/// The per-stage table, a line each.
[[nodiscard]] std::string report_table(const RunReport& report);

} // namespace toile::pipeline
