// A scan of a mannequin or a customer: cleaned up, and its parts found (P3 3.2, 3.3).
#pragma once

#include "body/skeleton.h"
#include "body/spectral_parts.h"
#include "geometry/clean_up.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace toile::mannequin_scan {

using Rgba = std::array<std::uint8_t, 4>;

/// The scan in metres, upright.
struct CleanScan {
    geometry::CleanMesh clean;
    std::vector<Rgba> colors; ///< (nv) of the clean mesh, or empty
    std::string unit;         ///< of the file: "m", "cm", "mm", "dm", "inch", "foot"
    double metres_per_unit = 1.0;
    std::optional<body::SpectralParts> parts; ///< none where arms or legs are hidden by cloth
    std::string why_no_parts;
};

/// `colors` (nv) or empty. The unit is the first in which the scan is as tall as a person.
/// \throw Error when there is no surface, nothing of human size, or what is there lies down
[[nodiscard]] CleanScan clean_scan(const geometry::TriangleMesh& scan,
                                   const std::vector<Rgba>& colors);

/// Where joints are, metres: the middles of the skin around them, found by its places in the space
/// of the eigenvectors. \throw Error when a joint has no skin around it
[[nodiscard]] std::array<Vec3f, body::kJointCount> joints_of(const geometry::TriangleMesh& mesh,
                                                             const body::SpectralParts& parts);

/// What was mended and found.
[[nodiscard]] nlohmann::ordered_json report_of(const CleanScan& scan);

} // namespace toile::mannequin_scan
