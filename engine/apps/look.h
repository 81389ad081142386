// A dressed person given to the renderer: uploaded once, moved each frame.
#pragma once

#include "apps/fit_map.h"
#include "apps/spoil.h"
#include "pipeline/dressed_person.h"
#include "render/frame_uniforms.h"
#include "render/renderer.h"
#include "render/views.h"

#include <functional>
#include <memory>
#include <vector>

namespace toile::apps {

/// Not movable. All calls on the context's thread.
class Look {
  public:
    /// `variant`: a colourway that every garment having it wears; "" the first of each. `map`: what
    /// garments are coloured by instead, on a grey body.
    /// \throw Error
    Look(render::Context& context, const render::RendererOptions& options,
         const pipeline::DressedPerson& person, const std::string& variant = "",
         FitMapKind map = FitMapKind::none);
    Look(const Look&) = delete;
    Look& operator=(const Look&) = delete;

    /// Draws wrongly from now on, for tests.
    void spoil(Spoil how);

    /// Takes over the person's surfaces as they are now. \throw Error when they are unfit
    void update();

    /// Draws the person seen from `view`, into the renderer's picture.
    void draw(const render::View& view, const render::Box& box);

    [[nodiscard]] render::Renderer& renderer() { return renderer_; }

  private:
    void add_body();
    void add_garment(const pipeline::WornGarment& garment, const std::string& variant);
    void add_surface(const pipeline::WornGarment& garment, std::size_t s,
                     std::span<const Vec2f> texcoords,
                     const std::function<render::MaterialId()>& material);
    void add_mapped(const pipeline::WornGarment& garment, std::size_t index,
                    render::MaterialId material);
    void update_map();

    const pipeline::DressedPerson& person_;
    render::Renderer renderer_;
    render::Scene scene_;
    render::MeshId body_ = render::MeshId::none;
    std::vector<render::MeshId> surfaces_; ///< of all garments, in order; none: wholly hidden
    std::unique_ptr<FitMap> map_;
};

/// Box round the person as it stands now, clothes included. World, metres.
[[nodiscard]] render::Box bounds_now(const pipeline::DressedPerson& person);

/// A box that holds a moving person: as wide as outstretched arms, as high as the body and a hand's
/// breadth more. It follows the hips, slower than they move.
class StageBox {
  public:
    explicit StageBox(const pipeline::DressedPerson& person);
    void follow(const pipeline::DressedPerson& person, double dt_s);

    [[nodiscard]] const render::Box& box() const { return box_; }

  private:
    render::Box box_;
    Vec3f centre_;
    float stature_;
};

} // namespace toile::apps
