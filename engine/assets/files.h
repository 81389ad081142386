// Reading and writing 3D files; the extension picks the format.
#pragma once

#include "assets/scene.h"

#include <cstddef>
#include <filesystem>

namespace toile::assets {

/// Bounds that keep a hostile file from taking the machine.
struct ImportLimits {
    std::size_t max_file_bytes = 256u << 20;
    std::size_t max_vertices = 2'000'000;
    std::size_t max_triangles = 4'000'000;
    std::size_t max_texture_side = 8192; ///< pixels
    /// Of everything decoded from one file: attributes, morph targets, textures.
    std::size_t max_decoded_bytes = 1u << 30;
};

/// Reads .glb and .gltf (tinygltf), .ply and .fbx (assimp) and .obj (one mesh per group, vertices
/// in the order of the file). Metres are assumed except where the format says otherwise (FBX: its
/// unit scale factor). Skins come out checked: see check_skins. \throw Error naming the file and
/// what is wrong with it
[[nodiscard]] Scene load_scene(const std::filesystem::path& file, const ImportLimits& limits = {});

struct SaveOptions {
    /// KHR_mesh_quantization: positions of meshes without skin and morphs in steps of 1 / 32768 m,
    /// normals of 1 / 127. Those meshes' nodes must stand at the origin and every position within
    /// 1 m of (0, 1, 0); others stay as they are.
    bool compact = false;
    /// Textures as PNG files beside the .glb, named as the textures, instead of in it.
    bool textures_beside = false;
    /// Of an .obj with textures: an .mtl and the pictures beside it, the former named as itself,
    /// these as the textures. Without, geometry and texture coordinates only.
    bool materials_beside = false;
};

/// Writes .glb, .obj or .ply. A .glb holds everything; .obj and .ply geometry only, an
/// .obj its materials too if asked.
/// \throw Error
void save_scene(const Scene& scene, const std::filesystem::path& file,
                const SaveOptions& options = {});

} // namespace toile::assets
