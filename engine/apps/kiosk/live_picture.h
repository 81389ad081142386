// The mirror's picture: what the camera sees with clothes over it, or a room with the avatar.
#pragma once

#include "apps/kiosk/hiding_depth.h"
#include "apps/kiosk/light.h"
#include "apps/kiosk/worn_meshes.h"
#include "apps/spoil.h"
#include "pipeline/sensor_source.h"
#include "render/frame_uniforms.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace toile::apps::kiosk {

/// Not movable; one for the program. All calls on the context's thread.
class LivePicture {
  public:
    /// \throw Error
    explicit LivePicture(render::Context& context);

    /// What the camera saw; the first frame of another size makes new textures. \throw Error
    void set_camera(const pipeline::SensorFrame& frame, const pipeline::SensorStream& stream);
    /// Before the first frame, and after `erase`.
    [[nodiscard]] bool empty() const { return width_ == 0; }
    /// Overwrites the last camera picture.
    void erase();

    /// What hides cloth in the next picture: the camera's depth with the bare arms of those who
    /// wear something brought forward. \throw Error
    struct Wearer {
        const pipeline::DressedPerson* person = nullptr;
        const std::vector<std::uint32_t>* bare = nullptr;
    };
    void hide_by(const pipeline::SensorFrame& frame, std::span<const Wearer> wearers);

    /// Places of a dressed person where the camera sees skin or clothes of it.
    void add_lit_places(const pipeline::DressedPerson& person, const pipeline::SensorFrame& frame,
                        std::vector<LitPlace>& out) const;
    /// Light is told anew and followed within about a second. `dt_s` since the last call.
    void follow_light(const pipeline::SensorFrame& frame, std::span<const LitPlace> places,
                      double dt_s);
    [[nodiscard]] const PictureTone& tone() const { return tone_; }
    [[nodiscard]] const PictureLight& light() const { return light_; }

    /// The camera's view; without colour a room with avatars. `scale`: share of the camera's
    /// resolution. \throw Error
    void draw_mirror(std::span<WornMeshes* const> worn, float scale);
    /// White where cloth covers the camera's picture, in its resolution; for measuring it.
    [[nodiscard]] imaging::Image cloth_mask(std::span<WornMeshes* const> worn);
    /// A studio, seen from `azimuth_deg` round the box. \throw Error
    void draw_studio(const WornMeshes& worn, float azimuth_deg, const render::Box& box, int width,
                     int height);

    [[nodiscard]] render::Renderer& renderer() { return renderer_; }
    /// Pixel of the camera's picture at a place of the world; nothing behind the camera.
    [[nodiscard]] std::optional<Vec2f> pixel_of(const Vec3f& world) const;
    [[nodiscard]] const Eigen::Isometry3d& camera_place() const { return place_; }
    [[nodiscard]] int camera_width() const { return width_; }
    [[nodiscard]] int camera_height() const { return height_; }

    /// Draws the camera's view wrongly from now on, for tests.
    void spoil(Spoil how) { spoil_ = how; }

    /// The driver compiles a shader when it is first drawn with: a second that no shopper shall
    /// wait. Call it while nobody is there.
    void warm_up();

  private:
    void spoil_scene();

    render::Renderer renderer_;
    render::Scene scene_;
    render::TextureId picture_ = render::TextureId::none;
    render::TextureId depth_ = render::TextureId::none;
    imaging::DepthImage hiding_; ///< scratch
    TrunkDepth trunk_;           ///< scratch
    imaging::Intrinsics camera_;
    Eigen::Isometry3d place_ = Eigen::Isometry3d::Identity();
    int width_ = 0;
    int height_ = 0;
    bool has_color_ = false;
    std::uint32_t sequence_ = 0;
    PictureTone tone_;
    PictureLight light_;
    Spoil spoil_ = Spoil::none;
};

} // namespace toile::apps::kiosk
