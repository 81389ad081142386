// Girths of a garment as a tailor takes them: where a body's tape lies, the cloth around it is
// measured flat, on its pattern, so that neither stretch nor folds change it.
#pragma once

#include "body/measurement.h"
#include "garment/contact_metrics.h"

#include <optional>
#include <span>
#include <vector>

namespace toile::garment {

/// A way along the cloth, once around a part of the body.
struct PatternTape {
    /// Within one triangle, between places on two of its sides (barycentric).
    struct Step {
        std::uint32_t triangle = 0;
        Vec3f from = Vec3f::Zero();
        Vec3f to = Vec3f::Zero();
    };
    std::vector<Step> steps;
    bool open = false;    ///< the garment is open here: from border to border
    double moved_m = 0.0; ///< how far along the plane's normal from the body's tape

    /// On the flat pattern of this size or another of the same design (3 nf); m.
    [[nodiscard]] double flat_length(std::span<const Vec2f> material_coords) const;
};

struct TapeOptions {
    float reach_m = 0.0f; ///< how far the tape may move along the part of the body
    /// Whether a curve from border to border counts when its ends lie near each other: an open
    /// front. Wrong for limbs, beside which a hem may be cut so.
    bool open = true;
};

/// Cuts the cloth in the plane of `girth`, a tape on the body as it stands (with `Reading::cut`).
/// Where no curve runs around that part of the body and no other (above a neckline, beyond a hem,
/// where a sleeve joins, where a skirt goes around both thighs) it moves along the part, to the
/// nearest level within `reach_m` that has one; nothing when there is none. Of the levels within
/// 12 mm of it the way of middle length is taken.
[[nodiscard]] std::optional<PatternTape>
lay_around(const body::Reading& girth, const ClothSurface& body, const ClothSurface& cloth,
           std::span<const Vec2f> material_coords, const TapeOptions& options = {});

} // namespace toile::garment
