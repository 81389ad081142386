// One dressed person in a renderer: body and garments, freed when taken off.
#pragma once

#include "pipeline/dressed_person.h"
#include "render/renderer.h"

#include <string>
#include <vector>

namespace toile::apps::kiosk {

/// How the body is drawn.
enum class BodyDrawn {
    invalid,
    picture, ///< not at all: it hides cloth behind it, and takes the cloth's shadow
    avatar,
};

/// Not movable. All calls on the renderer's thread.
class WornMeshes {
  public:
    /// Uploads; `colour` is an index into each garment's colourways. Both must outlive this.
    /// \throw Error
    WornMeshes(render::Renderer& renderer, const pipeline::DressedPerson& person,
               std::size_t colour);
    ~WornMeshes();
    WornMeshes(const WornMeshes&) = delete;
    WornMeshes& operator=(const WornMeshes&) = delete;

    /// Takes over the person's surfaces as they are now. \throw Error when they are unfit
    void update();
    /// Appends what is drawn. Garments are the last instances.
    void add_to(render::Scene& scene, BodyDrawn body) const;

  private:
    void add_body();
    void add_garment(const pipeline::WornGarment& garment, std::size_t colour);
    void release();

    render::Renderer& renderer_;
    const pipeline::DressedPerson& person_;
    render::MeshId body_ = render::MeshId::none;
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
