// Steps of assessing a fit (garment/fit.h). Private to this folder.
#pragma once

#include "garment/fit.h"
#include "garment/skin_gap.h"

namespace toile::garment {

/// The region of each vertex: that of the nearest skin, the trunk by its nearest level of bust,
/// waist and hip. FitRegion::invalid: head, neck, and a trunk without tapes.
[[nodiscard]] std::vector<FitRegion>
regions_of_vertices(const WearerView& wearer, const body::Figure& figure,
                    std::span<const body::LaidMeasurement> tapes, const SkinGap& gap,
                    std::span<const Vec3f> cloth);

/// Intended room, verdict and words for each region whose girth was measured.
[[nodiscard]] std::vector<RegionFit> judge_regions(const WornView& worn,
                                                   std::span<const GirthFit> girths);

/// For each region that is not as intended, what the next size in the right direction would give:
/// "in L the hip has 7.6 cm of room, in M 1.5 cm". Empty where there is no such size.
[[nodiscard]] std::vector<std::string> other_sizes(const GarmentFit& fit);

/// Adds stretch and pressure of each region's vertices.
void add_strain(std::span<const FitRegion> regions, const GarmentFit& fit,
                std::vector<RegionFit>& to);

/// Sleeve and hem.
[[nodiscard]] std::vector<LengthFit> lengths_of(const WearerView& wearer,
                                                const body::Figure& figure, const SkinGap& gap,
                                                std::span<const Vec3f> cloth);

/// What the figures of one garment say went wrong.
void add_failures(const GarmentFit& fit, std::vector<FitFailure>& failures);

} // namespace toile::garment
