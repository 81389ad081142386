// Which size of a garment suits a body, from the size chart alone.
#pragma once

#include "garment/package.h"

#include <map>
#include <string>

namespace toile::garment {

struct SizeChoice {
    std::size_t index = 0; ///< into GarmentPackage::sizes
    std::string reason;    ///< "M: waist_girth 0.78 m lies in 0.74 to 0.80 m"
    bool within = false;   ///< every deciding measurement lies in the chart's range
};

/// The size whose ranges the body's measurements miss least (summed in metres), the better centred
/// one between equals. `measurements`: ISO names to metres.
/// \throw Error when no size charts a measurement that the body has
[[nodiscard]] SizeChoice choose_size(const GarmentPackage& package,
                                     const std::map<std::string, double>& measurements);

} // namespace toile::garment
