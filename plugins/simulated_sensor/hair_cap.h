// Hair as a depth camera meets it: a cap over the scalp, some centimetres thick, full of holes.
#pragma once

#include "body/body_model.h"
#include "simulated_sensor/stage.h"

namespace toile::simulated_sensor {

struct HairSettings {
    float thickness_m = 0.02f; ///< at the crown; it thins out towards the hairline
    Vec3f color = Vec3f(0.035f, 0.022f, 0.014f); ///< linear
};

/// The scalp's vertices and how far the hair's surface stands off them along their normals.
class HairCap {
  public:
    /// Of a body at rest, facing +Z: positions and parts (nv). \throw Error when it has no head
    HairCap(const HairSettings& settings, std::span<const Vec3f> positions,
            std::span<const Triangle> triangles, std::span<const body::Part> parts);

    [[nodiscard]] const Surface& surface() const { return surface_; }
    /// Where the cap is on the posed body; all views (nv) of the body, the result has the cap's
    /// own vertices.
    [[nodiscard]] std::span<const Vec3f> pose(std::span<const Vec3f> positions,
                                              std::span<const Vec3f> normals);

  private:
    Surface surface_;
    std::vector<std::uint32_t> vertices_; // of the body
    std::vector<float> thickness_;        // metres
    std::vector<Vec3f> posed_;
};

} // namespace toile::simulated_sensor
