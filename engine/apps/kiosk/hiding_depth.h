// What of the camera's depth hides cloth: bare hands and arms lie before it.
#pragma once

#include "body/body_model.h"
#include "imaging/camera.h"
#include "imaging/image.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace toile::apps::kiosk {

/// The body as it is tracked; (nv) each, world, metres.
struct TrackedSkin {
    std::span<const Vec3f> positions, normals;
    std::span<const body::Part> parts;
};

/// Pixel that a point of the world falls on, and how far it is along the camera's axis.
struct SeenPixel {
    int x = 0, y = 0;
    float metres = 0.0f;
};
/// Nothing when it is behind the camera or within `border` pixels of the picture's edge, or beyond.
[[nodiscard]] std::optional<SeenPixel> seen_pixel(const imaging::Intrinsics& camera,
                                                  const Eigen::Isometry3d& from_world,
                                                  const Vec3f& at, int width, int height,
                                                  int border = 0);

/// May no cloth cover it, and may it stand before the trunk?
[[nodiscard]] bool is_arm(body::Part part);

/// How far the tracked trunk, head and legs are, in cells of the camera's picture. Nothing is
/// allocated once it has had a size.
class TrunkDepth {
  public:
    void fill(const TrackedSkin& skin, const imaging::Intrinsics& camera,
              const Eigen::Isometry3d& place, int width, int height);
    /// Is a reading too far to be a hand before the trunk? Not where no trunk is. [frame]
    [[nodiscard]] bool reaches(int x, int y, float metres) const;

  private:
    struct Cell {
        float sum = 0.0f; ///< m
        int count = 0;
    };
    int columns_ = 0;
    std::vector<Cell> cells_;
};

/// Brings depth readings of these vertices nearer by `lift_m`, in a picture that decides what hides
/// cloth: tracked skin and simulated cloth are centimetres off, and a hand laid on the trunk would
/// vanish in the cloth. Only readings that lie at most 6 cm before a vertex and 2 cm
/// behind it, and what is around them within `reach` pixels and 2 cm; none that reaches the trunk,
/// which a mistracked hand would tear out of the cloth. `out` has the size of `seen`. [frame]
void lift_bare_parts(const TrackedSkin& skin, const std::vector<std::uint32_t>& vertices,
                     const imaging::Intrinsics& camera, const Eigen::Isometry3d& place,
                     const imaging::DepthImage& seen, const TrunkDepth& trunk, float lift_m,
                     int reach, imaging::DepthImage& out);

} // namespace toile::apps::kiosk
