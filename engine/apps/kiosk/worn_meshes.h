// One dressed person in a renderer: body and garments, freed when taken off.
#pragma once

#include "pipeline/dressed_person.h"
#include "render/renderer.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::apps::kiosk {

/// How the body is drawn.
enum class BodyDrawn {
    invalid,
    /// Not at all: it hides cloth behind it, and takes the cloth's shadow. Without bare arms, which
    /// the camera's depth shows better than the tracked body.
    picture,
    avatar,
};

/// Not movable. All calls on the renderer's thread.
class WornMeshes {
  public:
    /// Uploads; `colour` is an index into each garment's colourways, `bare` are vertices of arms
    /// that no garment covers. Renderer and person must outlive this. \throw Error
    WornMeshes(render::Renderer& renderer, const pipeline::DressedPerson& person,
               std::size_t colour, std::span<const std::uint32_t> bare);
    ~WornMeshes();
    WornMeshes(const WornMeshes&) = delete;
    WornMeshes& operator=(const WornMeshes&) = delete;

    /// Takes over the person's surfaces as they are now. \throw Error when they are unfit
    void update();
    /// Appends what is drawn. Garments are the last instances.
    void add_to(render::Scene& scene, BodyDrawn body) const;

  private:
    void add_body(std::span<const std::uint32_t> bare);
    void add_garment(const pipeline::WornGarment& garment, std::size_t colour);
    void release();

    render::Renderer& renderer_;
    const pipeline::DressedPerson& person_;
    render::MeshId body_ = render::MeshId::none;
    render::MeshId receiver_ = render::MeshId::none; ///< the body without bare arms
    render::MaterialId picture_ = render::MaterialId::none;
    render::MaterialId avatar_ = render::MaterialId::none;
    struct Surface {
        render::MeshId mesh = render::MeshId::none;
        render::MaterialId material = render::MaterialId::none;
    };
    std::vector<Surface> surfaces_; ///< of all garments, in order; none: wholly hidden
    std::vector<render::MaterialId> materials_;
    std::vector<render::TextureId> textures_;
};

} // namespace toile::apps::kiosk
