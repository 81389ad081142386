// The light in a camera's picture, told from the person in it, so that cloth is lit alike.
#pragma once

#include "core/types.h"
#include "imaging/image.h"
#include "render/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::apps::kiosk {

/// One place of a person's skin or clothes that the camera sees.
struct LitPlace {
    Vec3f normal = Vec3f::UnitZ(); ///< unit, world
    Vec3f color = Vec3f::Zero();   ///< linear
    std::uint8_t group = 0;        ///< places that may be of one colour: a part of the body
};

/// Light as far as a picture tells it: E(n) = level tint (1 + contrast direction . n).
struct PictureLight {
    Vec3f direction = Vec3f(0.0f, 0.8f, 0.6f); ///< unit, towards the brighter side
    float contrast = 0.35f;                    ///< [0, 1]
    float level = 0.8f;                        ///< what a white surface would send back, linear
    Vec3f tint = Vec3f::Ones();                ///< mean 1
};

struct PictureTone {
    float level = 0.0f;         ///< as in PictureLight
    Vec3f tint = Vec3f::Ones(); ///< half of what the picture's mean deviates from grey
    float clipped = 0.0f;       ///< share of pixels that are white
    float noise = 0.0f;         ///< standard deviation of sRGB values, shares of full
};

/// Of a whole picture, every few pixels: surfaces send back a third of the light on the whole.
[[nodiscard]] PictureTone picture_tone(const imaging::Image& picture);

/// Direction and contrast from the places, each group with a colour of its own; level and tint of
/// the tone. Too few places (less than 60): `before` with the tone's level.
[[nodiscard]] PictureLight estimate_light(std::span<const LitPlace> places, const PictureTone& tone,
                                          const PictureLight& before);

/// `now` a little nearer to `seen`; no flicker. `share` in [0, 1].
[[nodiscard]] PictureLight blended(const PictureLight& now, const PictureLight& seen, float share);

/// For the renderer: a key light and surroundings with that E(n), averaged over directions.
[[nodiscard]] render::Lighting lighting_of(const PictureLight& light);

} // namespace toile::apps::kiosk
