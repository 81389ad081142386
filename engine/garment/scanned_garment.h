// A garment taken off a scanned mannequin, as a package.
#pragma once

#include "garment/cloth_cover.h"
#include "garment/package.h"

namespace toile::garment {

/// The cloth of a scan as a sheet of its own, where it was seen.
struct ScannedGarment {
    geometry::TriangleMesh mesh;  ///< even triangles, open at its hems; with normals
    std::vector<Vec2f> coords;    ///< (3 nf) material coordinates, metres
    std::vector<Vec2f> texcoords; ///< (3 nf) of `picture`
    imaging::Image picture;       ///< its colours, or empty
};

/// `scan` with normals; `colors` (nv) or none; `cover` tells its cloth. Caps that close a hem are
/// taken out; the largest piece is the garment. \throw Error when there is hardly any cloth
[[nodiscard]] ScannedGarment separate_garment(const geometry::TriangleMesh& scan,
                                              std::span<const std::array<std::uint8_t, 4>> colors,
                                              const ClothCover& cover);

struct ScannedPackageOptions {
    std::string id;                       ///< of the package
    std::string made_on;                  ///< avatar id
    std::map<std::string, double> wearer; ///< measurements of whom it was scanned on, metres
};

/// One size, in memory. `positions` (nv) of the garment on the avatar; `gaps` (nv) from its skin,
/// and its height: what hangs below the bust only is pinned along its upper edge where it touches.
[[nodiscard]] GarmentPackage package_scanned(const ScannedGarment& garment,
                                             std::vector<Vec3f> positions,
                                             std::span<const float> gaps, double stature_m,
                                             const ScannedPackageOptions& options);

} // namespace toile::garment
