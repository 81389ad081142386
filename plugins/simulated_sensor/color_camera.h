// The colour picture that goes with a depth camera, already registered to it: same rays.
#pragma once

#include "simulated_sensor/depth_camera.h"

namespace toile::simulated_sensor {

/// One lamp and the light that the room throws back. Linear colours.
struct Lighting {
    Vec3f lamp_position = Vec3f(0.9f, 2.6f, 2.2f);    ///< world, metres
    Vec3f lamp_color = Vec3f(5.0f, 4.7f, 4.2f);       ///< irradiance at one metre
    Vec3f ambient_color = Vec3f(0.30f, 0.32f, 0.36f); ///< from above; 40 % of it from below
};

/// Buffers are taken once; `shade` allocates nothing.
class ColorCamera {
  public:
    ColorCamera(const CameraSettings& settings, std::uint64_t seed, std::uint32_t number);

    /// Colours what `depth` looked at last: textures and grain, lamp with its shadow, a lens that
    /// blurs by half a pixel, noise.
    void shade(const Stage& stage, const DepthCamera& depth, const Lighting& lighting,
               std::uint32_t frame, const RowLoop& rows);

    [[nodiscard]] const imaging::Image& picture() const noexcept { return picture_; }

  private:
    double noise_;
    std::uint64_t seed_;
    std::uint32_t number_;
    std::vector<Vec3f> light_;   // (pixels) linear
    std::vector<Vec3f> blurred_; // (pixels) along rows
    imaging::Image picture_;
};

/// Share of the light that a point's grain returns, about 1; `p` is its place at rest.
[[nodiscard]] Vec3f grain_color(Grain grain, const Vec3f& p) noexcept;

} // namespace toile::simulated_sensor
