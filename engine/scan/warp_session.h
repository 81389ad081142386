// Frames of one camera to the surface of a person who moves: who sways and breathes while turning
// (P2), or moves the limbs (P4); as the person stood in the first of them.
#pragma once

#include "scan/fusion.h"
#include "scan/warp_fusion.h"

#include <nlohmann/json.hpp>

namespace toile::scan {

struct WarpSessionOptions {
    MovingSubjectOptions subject;
    WarpFusionOptions warp;
    bool by_parts = true; ///< limbs first, one after another, where the body tells its parts
    PartStage parts;      ///< how; its groups are the body's
};

struct WarpSessionResult {
    geometry::TriangleMesh mesh; ///< in the world: the camera's, or upright with the lowest at 0
    std::vector<Rgba8> colors;
    nlohmann::ordered_json report;
};

/// \throw Error wherever nothing can be made of what was fed, saying why
class WarpSession {
  public:
    WarpSession(IntakeCamera camera, const WarpSessionOptions& options, RowLoop rows);

    /// As `MovingSubject`'s; part labels are those of the plugin boundary (TOILE_PART_*).
    void add(std::span<const float> depth, std::span<const Rgba8> color) {
        subject_.add(depth, color);
    }
    void guide(std::uint32_t instant, geometry::TriangleMesh body,
               std::span<const std::uint8_t> labels) {
        subject_.guide(instant, std::move(body), labels);
    }
    /// `progress(share)` may throw to stop.
    [[nodiscard]] WarpSessionResult finish(const std::function<void(double)>& progress);

  private:
    [[nodiscard]] MovingTemplate stiff_template(nlohmann::ordered_json& report) const;
    [[nodiscard]] MovingTemplate body_template(nlohmann::ordered_json& report) const;
    [[nodiscard]] FusionOptions rough() const;

    WarpSessionOptions options_;
    RowLoop rows_;
    MovingSubject subject_;
};

} // namespace toile::scan
