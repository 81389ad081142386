// Which size of a garment suits a body, from the size chart alone.
#pragma once

#include "garment/package.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace toile::garment {

struct SizeChoice {
    std::size_t index = 0; ///< into GarmentPackage::sizes
    std::string reason;    ///< "M: waist_girth 0.78 m lies in 0.74 to 0.80 m"
    bool within = false;   ///< every deciding measurement lies in the chart's range
    /// The neighbouring size that a body a little larger or smaller would get, if there is one.
    std::optional<std::size_t> between;
    /// For people, in centimetres: each charted measurement, then, between two sizes, how they
    /// differ.
    std::vector<std::string> reasons;
};

struct SizeChoiceOptions {
    /// How far a body's girths may be off: who is nearer to a boundary is between two sizes. Mean
    /// absolute errors of fitted girths are 5 to 15 mm (docs/fit_accuracy.md).
    double tolerance_m = 0.01;
};

/// The size whose ranges the body's measurements miss least (summed in metres), the better centred
/// one between equals. `measurements`: ISO names to metres.
/// \throw Error when no size charts a measurement that the body has
[[nodiscard]] SizeChoice choose_size(const GarmentPackage& package,
                                     const std::map<std::string, double>& measurements,
                                     const SizeChoiceOptions& options = {});

} // namespace toile::garment
