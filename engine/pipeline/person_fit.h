// The fit report of a dressed person as it stands.
#pragma once

#include "garment/fit.h"
#include "pipeline/dressed_person.h"

namespace toile::pipeline {

/// Not for the per-frame path. A body that cannot be measured (a model without landmarks) is an
/// Error; all else that goes wrong stands in the report.
[[nodiscard]] garment::FitReport fit_of(DressedPerson& person);

} // namespace toile::pipeline
