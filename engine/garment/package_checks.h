// What makes a garment package fit for use beyond being readable.
#pragma once

#include "garment/package.h"

namespace toile::garment {

/// Mesh sound and manifold, material coordinates of sane area and scale, skin weights.
void check_simulation(const GarmentSize& size, const std::string& shown,
                      const PackageLimits& limits, Faults& faults);

/// Metres, and near the body it was made on (null: absolute bounds of a person only).
void check_unit(const GarmentSize& size, const std::string& shown,
                const geometry::TriangleMesh* body, Faults& faults);

/// Every render vertex within the limit of the simulation mesh.
void check_render(const GarmentSize& size, const std::string& shown, const PackageLimits& limits,
                  Faults& faults);

/// One topology for all sizes; pins and variants name what is there. Fills package.pins.
void check_across_sizes(GarmentPackage& package, const std::string& shown, Faults& faults);

} // namespace toile::garment
