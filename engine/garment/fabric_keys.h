// The numbers of garment.json's `fabric`, with their units in the file and sane ranges.
#pragma once

#include "garment/manifest.h"
#include "garment/manifest_reader.h"

#include <array>

namespace toile::garment {

constexpr Quantity kWeight = {"weight", "g/m2", 15.0,
                              2000.0,   1e-3,   "the unit is g/m2, so 0.18 kg/m2 is written 180"};
constexpr Quantity kThickness = {"thickness", "mm", 0.05,
                                 15.0,        1e-3, "the unit is mm, so 0.0005 m is written 0.5"};
constexpr Quantity kStretchWarp = {"stretch_warp", "N/m", 5.0, 1e5, 1.0, "a T-shirt has about 300"};
constexpr Quantity kStretchWeft = {"stretch_weft", "N/m", 5.0, 1e5, 1.0, "a T-shirt has about 200"};
constexpr Quantity kShear = {"shear", "N/m", 1.0, 1e5, 1.0, "a T-shirt has about 60"};
constexpr Quantity kBendingWarp = {"bending_warp", "N m", 1e-8,
                                   1e-2,           1.0,   "cloth lies between 1e-7 and 1e-3 N m"};
constexpr Quantity kBendingWeft = {"bending_weft", "N m", 1e-8,
                                   1e-2,           1.0,   "cloth lies between 1e-7 and 1e-3 N m"};
constexpr Quantity kFriction = {"friction", "", 0.0, 2.0, 1.0, ""};
constexpr Quantity kDamping = {"damping", "1/s", 0.0, 60.0, 1.0, ""};
struct FabricKey {
    Quantity quantity;
    double Fabric::*field;
};
constexpr std::array<FabricKey, 9> kFabricKeys = {{{kWeight, &Fabric::density_kg_m2},
                                                   {kThickness, &Fabric::thickness_m},
                                                   {kStretchWarp, &Fabric::stretch_warp_n_m},
                                                   {kStretchWeft, &Fabric::stretch_weft_n_m},
                                                   {kShear, &Fabric::shear_n_m},
                                                   {kBendingWarp, &Fabric::bending_warp_nm},
                                                   {kBendingWeft, &Fabric::bending_weft_nm},
                                                   {kFriction, &Fabric::friction},
                                                   {kDamping, &Fabric::damping}}};

} // namespace toile::garment
