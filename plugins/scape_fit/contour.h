// Outlines: where a camera sees the person end, and where the model would. They tell sizes across
// the line of sight, whatever is wrong with the depths.
#pragma once

#include "core/row_loop.h"
#include "scape_fit/association_types.h"
#include "scape_fit/cloth_gaps.h"
#include "scape_fit/fit_model.h"
#include "scape_fit/observation.h"

namespace toile::scape_fit {

/// Unit directions (world) from the camera to the person's outline: between a pixel of the person
/// and one beside it that shows something well behind. Where the camera has no reading there is
/// none.
[[nodiscard]] std::vector<Vec3f> outline(const DepthView& view, std::span<const std::uint8_t> mask);

/// The model's own outline as `eye` sees it, paired with directions `edges` (corrected), summed up
/// at vertices. Pairs farther than `reach_m` are left out; `weight` is the area (m^2) that one
/// direction counts as; `cloth` (or none) lowers it where the model lies inside the outline of a
/// dressed person.
class ContourPairing {
  public:
    explicit ContourPairing(const FitLevel& level);

    void pair(const PosedLevel& posed, const Vec3f& eye, std::span<const Vec3f> edges,
              float reach_m, float scale_m, float weight, const ClothGaps* cloth,
              std::vector<VertexPair>& out);

  private:
    const FitLevel& level_;
    std::vector<std::array<std::uint32_t, 2>> edges_; ///< of the level's triangles, each once
    std::vector<VertexPair> sums_;
};

} // namespace toile::scape_fit
