// Starts a garment package from a retailer's mesh.
#pragma once

#include "garment/package.h"
#include "garment/placement.h"

namespace toile::garment {

struct ImportOptions {
    std::string id;
    std::string name; ///< "" : from the id
    std::string maker = "unknown";
    std::string licence = "not stated";
    std::string kind = "garment";
    std::string size_name = "M";
    std::map<std::string, ChartRange> chart; ///< of that size
    std::string made_on;                     ///< avatar id, or "" to leave the mesh where it is
    std::optional<Unit> unit;                ///< nothing: find out
    std::uint32_t layer = 1;
};

struct Import {
    GarmentPackage package;
    std::vector<std::string> findings; ///< in plain words, one line each
};

/// Reads .glb, .gltf, .fbx or .obj; finds unit, axes and place on `body` (null: none), mends the
/// mesh, makes material coordinates; on a body with its skeleton it also lays a garment of another
/// pose into the body's, tells its pieces and openings, and proposes pins. The mesh as it came is
/// the render mesh. `body` (null: none) at rest; without part labels it counts as a surface only.
/// \throw Error
[[nodiscard]] Import import_garment(const std::filesystem::path& mesh, const ImportOptions& options,
                                    const body::BodyModel* body);

/// Usual fabric of a kind of garment: jersey for a t-shirt, denim for jeans, ...
[[nodiscard]] Fabric usual_fabric(const std::string& kind);

} // namespace toile::garment
