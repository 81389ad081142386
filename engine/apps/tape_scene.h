// A body with tapes on it, given to the renderer: what pictures of measurements are made of.
#pragma once

#include "apps/label.h"
#include "body/body_model.h"
#include "geometry/nearest_surface.h"
#include "geometry/tape.h"
#include "imaging/image.h"
#include "render/frame_uniforms.h"
#include "render/renderer.h"
#include "render/views.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace toile::apps {

/// A point of a tape and whether the body leaves it in sight.
struct SeenPoint {
    Vec2f pixel;  ///< from the top left
    bool visible; ///< not behind the body
};

/// Not movable. Tapes are world curves, metres, as `body::lay_tapes` gives them.
class TapeScene {
  public:
    enum class Backdrop : std::uint8_t { white, studio };

    /// Pictures of width x height pixels. `model` (at rest) must outlive this. \throw Error
    TapeScene(const body::BodyModel& model, int width, int height, Backdrop backdrop);
    TapeScene(const TapeScene&) = delete;
    TapeScene& operator=(const TapeScene&) = delete;

    /// Adds curves as cords of this radius; open ones end in knobs.
    void lay(std::span<const geometry::Loop> tapes, const Color& color, float radius_m);
    void take_off();

    /// What the camera sees; tapes that run through the body or behind it shine through faintly.
    [[nodiscard]] imaging::Image draw(const render::Camera& camera);

    /// Points along a curve, 5 mm apart, as the camera sees them.
    [[nodiscard]] std::vector<SeenPoint> seen(const geometry::Loop& tape,
                                              const render::Camera& camera) const;

    [[nodiscard]] const render::Box& bounds() const { return bounds_; }

  private:
    std::unique_ptr<render::Context> context_;
    render::Renderer renderer_;
    geometry::NearestSurface surface_;
    render::Scene scene_; ///< the body first, then tapes
    render::Background backdrop_;
    bool floor_;
    render::Box bounds_;
};

} // namespace toile::apps
