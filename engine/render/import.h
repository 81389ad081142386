// From 3D files' neutral form to drawables.
#pragma once

#include "assets/scene.h"
#include "render/frame_uniforms.h"
#include "render/renderer.h"

namespace toile::render {

struct ImportedScene {
    std::vector<Instance> instances;
    Box bounds; ///< world, as drawn
};

/// Material with its textures; those of `scene` that are used are uploaded once.
[[nodiscard]] std::vector<MaterialId> add_materials(Renderer& renderer, const assets::Scene& scene);

/// Adds all meshes of a file where its nodes put them (skinned ones in their bind pose). `fallback`
/// is for primitives without a material. \throw Error
[[nodiscard]] ImportedScene add_scene(Renderer& renderer, const assets::Scene& scene,
                                      const Material& fallback);

/// Matte warm grey, as a shop's mannequin.
[[nodiscard]] Material mannequin_material();
/// Plain woven cloth of a linear colour.
[[nodiscard]] Material cloth_material(const Vec3f& color);

} // namespace toile::render
