// What `toile scan` leaves behind: the surface in the wanted size, a report, a picture, a rig.
#pragma once

#include "apps/global_options.h"
#include "pipeline/scanning.h"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace toile::apps {

struct ScanOutput {
    std::filesystem::path file, report, picture;
    std::size_t triangles = 0;    ///< at most so many; 0: all
    int texture = 0;              ///< texels a side; 0: colours of vertices
    bool rig = false;             ///< skeleton and skin weights through the fitted body
    std::filesystem::path motion; ///< of the rigged scan, in the file and the picture
};

/// --out, --report, --picture, --triangles, --texture, --rig, --motion.
void add_scan_output(CLI::App& command, ScanOutput& output);

/// Before the work: folders that are there, formats that hold what is wanted. \throw UsageError
void check(const ScanOutput& output);

/// \throw Error
void save(pipeline::ScannedSurface scanned, const ScanOutput& output, host::Registry& registry,
          host::Services& services, const toile_limits& limits);

} // namespace toile::apps
