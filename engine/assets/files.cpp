#include "assets/files.h"

#include "assets/formats.h"
#include "assets/skins.h"
#include "core/bytes.h"

#include <algorithm>
#include <limits>
#include <new>

namespace toile::assets {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
    std::string text = file.extension().string();
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

void save_obj(const Scene& scene, const std::filesystem::path& file, bool materials) {
    const std::string library = materials ? file.stem().string() + ".mtl" : "";
    write_text(file, write_obj(scene, library));
    if (!materials) return;
    write_text(file.parent_path() / library, write_mtl(scene));
    for (const Texture& texture : scene.textures)
        write_bytes(file.parent_path() / (texture.name + ".png"),
                    imaging::encode_png(texture.image));
}

} // namespace

Scene load_scene(const std::filesystem::path& file, const ImportLimits& limits) {
    const std::string extension = lower_extension(file);
    const std::string name = file.string();
    Budget budget(limits, name);
    SkinRules rules;
    Scene scene;
    try {
        if (extension == ".glb" || extension == ".gltf") {
            scene = read_gltf(file, budget);
        } else if (extension == ".obj") {
            scene = read_obj(file, budget);
        } else if (extension == ".ply") {
            scene = read_ply(file, budget);
        } else if (extension == ".fbx") {
            scene = read_fbx(file, budget);
            rules.sum_tolerance = std::numeric_limits<double>::infinity();
        } else {
            throw FileError(name, "unknown kind of 3D file (.glb, .gltf, .fbx, .obj and .ply are "
                                  "read)");
        }
    } catch (const std::bad_alloc&) {
        throw FileError(name, "needs more memory than there is");
    }
    check_skins(scene, name, rules);
    return scene;
}

void save_scene(const Scene& scene, const std::filesystem::path& file, const SaveOptions& options) {
    const std::string extension = lower_extension(file);
    if (extension == ".glb") {
        write_bytes(file, write_glb(scene, options));
        for (const Texture& texture : scene.textures)
            if (options.textures_beside)
                write_bytes(file.parent_path() / (texture.name + ".png"),
                            imaging::encode_png(texture.image));
    } else if (extension == ".obj")
        save_obj(scene, file, options.materials_beside && !scene.textures.empty());
    else if (extension == ".ply")
        write_bytes(file, write_ply(scene));
    else
        throw FileError(file.string(), "3D files are written as .glb, .obj or .ply");
}

} // namespace toile::assets
