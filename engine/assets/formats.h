// The readers and writers behind files.h, one per family of formats.
#pragma once

#include "assets/budget.h"
#include "assets/files.h"
#include "assets/scene.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace toile::assets {

/// .glb and .gltf. Skins are not checked yet. \throw FileError
[[nodiscard]] Scene read_gltf(const std::filesystem::path& file, Budget& budget);
/// .obj. Vertices stay in the order of the file. \throw FileError
[[nodiscard]] Scene read_obj(const std::filesystem::path& file, Budget& budget);
/// .ply, text or binary; colours are not kept. \throw FileError
[[nodiscard]] Scene read_ply(const std::filesystem::path& file, Budget& budget);
/// .fbx by assimp. Skins are not checked yet. \throw FileError
[[nodiscard]] Scene read_fbx(const std::filesystem::path& file, Budget& budget);

/// A whole .glb. \throw Error when the scene contradicts itself
[[nodiscard]] std::vector<std::uint8_t> write_glb(const Scene& scene,
                                                  const SaveOptions& options = {});
/// All meshes where their nodes stand, text; with `library` (a file's name) the names of their
/// materials too. \throw Error
[[nodiscard]] std::string write_obj(const Scene& scene, const std::string& library = "");
/// The materials of such an .obj: colour and `<texture>.png`. \throw Error
[[nodiscard]] std::string write_mtl(const Scene& scene);
[[nodiscard]] std::vector<std::uint8_t> write_ply(const Scene& scene);

} // namespace toile::assets
