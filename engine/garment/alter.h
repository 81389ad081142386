// A garment made anew for another body: the same design with the same room (P2 5.1).
#pragma once

#include "garment/package.h"

#include <map>
#include <span>
#include <string>

namespace toile::garment {

struct AlterOptions {
    std::string id;
    std::string name; ///< "" : the package's
    std::string size_name = "made to measure";
    std::string made_on; ///< avatar id of the body, or "" when it is none
    /// ISO names to metres, of the body: its size chart has the old one's ranges around these.
    std::map<std::string, double> measurements;
};

struct Alteration {
    GarmentPackage package; ///< one size
    /// Of the flat pattern against the old one, by area: mean, and largest and smallest of any
    /// triangle, along warp and weft.
    double mean_warp = 1.0, mean_weft = 1.0;
    double least = 1.0, most = 1.0;
};

/// `carried` (nv): the size's simulation mesh as laid on the other body with its details and its
/// room kept (Laplacian surface editing). The cloth is cut anew: the flat pattern is stretched as
/// the carried mesh is, so that the garment is as loose there as it was here; render meshes follow.
/// \throw Error
[[nodiscard]] Alteration alter(const GarmentPackage& package, const GarmentSize& size,
                               std::span<const Vec3f> carried, const AlterOptions& options);

} // namespace toile::garment
