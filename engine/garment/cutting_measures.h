// What FreeSewing's designs ask of a body, under FreeSewing's names.
#pragma once

#include "garment/block_body.h"

#include <map>

namespace toile::garment::block {

/// Millimetres, degrees for shoulderSlope. Taken as docs/garments.md says, from body/measurement.h
/// and slices of the rest surface. \throw Error naming a measurement that the body does not allow
[[nodiscard]] std::map<std::string, double> cutting_measures(const BodyProbe& body);

} // namespace toile::garment::block
