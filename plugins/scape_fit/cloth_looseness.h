// How loose clothes are at each girth, from how they move over the poses (P5 eq. 30).
#pragma once

#include "body/measurer.h"
#include "scape_fit/association.h"
#include "scape_fit/fit_solver.h"
#include "scape_fit/free_form.h"

#include <string>

namespace toile::scape_fit {

struct Looseness {
    std::string girth;      ///< ISO name
    double looseness = 0.0; ///< standard deviation of the cloth's girth by its mean (P5 eq. 30)
    double ease_m = 0.0;    ///< mean girth of the cloth beyond the body's
};

/// The cloth's surface is found at each instant as a field over the fitted body; its girths are
/// taken at rest, as the body's are. Nothing for fewer than two instants.
[[nodiscard]] std::vector<Looseness>
measure_looseness(const FitModel& model, const body::Measurer& measurer, const FitState& state,
                  std::span<const Observation> observations, const RowLoop& rows);

} // namespace toile::scape_fit
