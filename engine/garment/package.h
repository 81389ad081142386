// A garment package: manifest, simulation mesh and render meshes of every size. Immutable once
// loaded. Format: docs/file_formats.md.
#pragma once

#include "assets/scene.h"
#include "garment/manifest.h"
#include "geometry/mesh.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace toile::garment {

/// One size. The simulation mesh has one topology over all sizes of a package, and so has each
/// render mesh.
struct GarmentSize {
    SizeEntry entry;
    geometry::TriangleMesh simulation;  ///< welded; metres, in the world of the body it was made on
    std::vector<Vec2f> material_coords; ///< (3 nf) per corner: metres along weft (u), warp (v)
    body::SkinWeights skin;             ///< (nv), or empty: the binder finds weights
    /// Only what is drawn: node i is placed at the identity and shows mesh i (all transforms are
    /// baked into the vertices). Without a render mesh in the file: the simulation mesh itself
    /// with its material coordinates as texture coordinates.
    assets::Scene render;
};

struct GarmentPackage {
    Manifest manifest;
    std::filesystem::path source; ///< folder or zip that it was read from
    std::vector<GarmentSize> sizes;
    std::vector<float> pins;        ///< (nv) 0 free .. 1 held; empty when nothing is pinned
    std::vector<std::string> notes; ///< what a reader should know, one line each; no faults

    /// \throw Error listing the sizes there are
    [[nodiscard]] const GarmentSize& size(const std::string& name) const;
};

/// What a package is held against.
struct PackageLimits {
    std::size_t max_file_bytes = 256u << 20;    ///< one file
    std::size_t max_package_bytes = 512u << 20; ///< all files of an unpacked zip
    std::size_t max_vertices = 100'000;         ///< of a simulation mesh
    double max_render_distance = 0.05;          ///< metres from the simulation mesh
    /// Rest surface of the avatar that a package was made on, e.g. from load_body_model; throws
    /// Error when there is none. Empty: the mesh is held against the bounds of any person.
    std::function<geometry::TriangleMesh(const std::string& avatar)> body_of;
};

/// Reads a folder or .zip. \throw PackageError with the first fault
[[nodiscard]] std::shared_ptr<const GarmentPackage>
load_package(const std::filesystem::path& folder_or_zip, const PackageLimits& limits = {});

/// Every fault that can be found; empty for a sound package. Notes go to `notes` when given.
[[nodiscard]] Faults check_package(const std::filesystem::path& folder_or_zip,
                                   const PackageLimits& limits = {},
                                   std::vector<std::string>* notes = nullptr);

/// Writes `folder`/garment.json and one GLB a size (named by entry.mesh, which must end in .glb):
/// node `simulation` with the material coordinates as TEXCOORD_0, then the nodes of
/// GarmentSize::render. Vertex order survives a round trip. `compact`: positions in steps of
/// 1 / 32768 m and textures once, as files beside the meshes, for all sizes. \throw Error
void write_package(const GarmentPackage& package, const std::filesystem::path& folder,
                   bool compact = false);

/// Packs a sound package folder; only the files it uses, equal input, equal bytes.
/// \throw PackageError, Error
void pack_package(const std::filesystem::path& folder, const std::filesystem::path& zip);

/// Folder or zip of a garment by id in the data folders, or `id` itself when it is a path.
/// \throw PackageError listing the known ids
[[nodiscard]] std::filesystem::path find_garment(const std::string& id);

/// Ids of all garments in the data folders, sorted.
[[nodiscard]] std::vector<std::string> list_garments();

} // namespace toile::garment
