// The measurements that Toile knows, and taking them on a figure.
#pragma once

#include "body/survey.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::body {

struct Measurement {
    std::string_view name; ///< of a definition; lives as long as the program
    double value_m = 0.0;
    double confidence = 0.0; ///< [0, 1]
};
using Measurements = std::vector<Measurement>;

enum class MeasurementKind : std::uint8_t { invalid, height, girth, length, breadth };

/// One row of docs/measurements.md.
struct MeasurementDefinition {
    std::string_view name; ///< ISO 8559-1 in snake_case; `ansur_...`: taken as in that survey
    MeasurementKind kind = MeasurementKind::invalid;
    std::string_view ansur_column; ///< of ANSUR II's tables, measured the same way; or empty
    std::string_view text;         ///< landmarks, plane or path, in one sentence
    Reading (*read)(Survey&) = nullptr;
};

/// All of them, in the order of the documentation.
[[nodiscard]] std::span<const MeasurementDefinition> measurement_definitions();
/// \throw Error naming a similar one when there is none of this name
[[nodiscard]] const MeasurementDefinition& measurement_definition(std::string_view name);
[[nodiscard]] std::vector<const MeasurementDefinition*>
measurement_definitions(std::span<const std::string> names);

/// A measurement with its tapes, for pictures and for laying the same tape on another surface.
struct LaidMeasurement {
    const MeasurementDefinition* definition = nullptr;
    Reading reading;
};

/// Takes measurements; a name that a body does not allow (a tape that meets nothing) comes with
/// value 0 and confidence 0. About 0.1 ms each.
[[nodiscard]] Measurements measure(const Figure& figure,
                                   std::span<const MeasurementDefinition* const> definitions);
[[nodiscard]] std::vector<LaidMeasurement>
lay_tapes(const Figure& figure, std::span<const MeasurementDefinition* const> definitions);

/// The girth of another surface where a girth's tape lay on the first: around what its curves in
/// the tape's plane that have their middle within the tape show at most `reach_m` outside of it;
/// m, 0 for none.
[[nodiscard]] double girth_at_same_place(const Reading& girth, std::span<const Vec3f> positions,
                                         std::span<const Triangle> triangles,
                                         double reach_m = 0.03);

} // namespace toile::body
