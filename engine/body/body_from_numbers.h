// The most likely body with given measurements.
#pragma once

#include "body/body_space.h"

#include <functional>
#include <map>
#include <string>

namespace toile::body {

using NamedLengths = std::map<std::string, double>; ///< ISO name -> metres

/// How bodies are measured: all names that may be asked for.
using MeasureBody = std::function<NamedLengths(const BodyShape&)>;

/// Measures bodies of the space by those definitions (see body/measurement.h). \throw Error for an
/// unknown name
[[nodiscard]] MeasureBody measure_by_definitions(const BodyModel& model,
                                                 std::span<const std::string> names);

struct NumbersOptions {
    double tolerance_m = 0.002;     ///< each measurement is hit within this
    int rounds = 12;                ///< of Gauss-Newton
    double farthest_deviations = 6; ///< from the population's middle; beyond, nobody is like that
};

struct BodyFromNumbers {
    Eigen::VectorXd coefficients; ///< (k)
    NamedLengths measurements;    ///< of the body made, all that is measured
    double deviations = 0.0;      ///< its distance from the population's middle
};

/// Gauss-Newton for the most likely coefficients of that sex's population (normal prior) under
/// the condition that the body measures `wanted`; derivatives by differences.
/// \throw Error naming an unknown measurement, or for a set that nobody has the measurement that
/// conflicts most with the others and the range that would go with them
[[nodiscard]] BodyFromNumbers body_from_numbers(const BodySpace& space, Sex sex,
                                                const NamedLengths& wanted,
                                                const MeasureBody& measure,
                                                const NumbersOptions& options = {});

} // namespace toile::body
