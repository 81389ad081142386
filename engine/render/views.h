// Where a photographer would stand: cameras and lights that frame a body.
#pragma once

#include "render/scene.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toile::render {

/// A direction to look from. Degrees round the vertical axis: 0 sees the front, 90 the body's left.
struct View {
    std::string name;
    float azimuth_deg = 0.0f;
    float height_deg = 0.0f; ///< of the camera above the subject's middle
};

/// "front", "back", "left", "right", "three_quarter", "three_quarter_left", "three_quarter_back",
/// "above". \throw UsageError naming the known ones
[[nodiscard]] View view_from_name(std::string_view name);
/// Splits "front,back". \throw UsageError
[[nodiscard]] std::vector<View> views_from_names(std::string_view names);

struct Framing {
    float lens_mm = 65.0f; ///< as on a 24 x 36 mm sensor, its long side along the picture's
    float margin = 0.07f;  ///< free on each side, share of the picture
};

/// The camera that shows all of a box: level, at the height of its middle (verticals stay
/// parallel), as near as the margins allow.
[[nodiscard]] Camera frame_view(const View& view, const Vec3f& low, const Vec3f& high, int width,
                                int height, const Framing& framing = {});

/// Studio lights that turn with the camera: key high on its left, fill on its right, rim behind.
[[nodiscard]] Lighting studio_lighting(const Camera& camera);

/// Bounds of points; \throw Error when there are none
void bounds(std::span<const Vec3f> points, Vec3f& low, Vec3f& high);

} // namespace toile::render
