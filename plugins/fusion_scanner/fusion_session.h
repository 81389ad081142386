// Frames to the surface of a rigid subject: of one camera that goes around it, or before which it
// turns; or of several that are fixed to each other and know where they stand.
#pragma once

#include "scan/intake.h"
#include "scan/rig_fusion.h"

#include <deque>
#include <nlohmann/json.hpp>

namespace toile::fusion_scanner {

struct SessionOptions {
    scan::FilterOptions filter;
    scan::FusionOptions fusion;
    bool choose_radius = true;   ///< rougher readings are smoothed more widely
    int averaged_frames = 1;     ///< of so many frames in a row one picture is made
    scan::CameraFreedom cameras; ///< how far several are corrected by what they see
};

struct SessionResult {
    geometry::TriangleMesh mesh; ///< in the world: the camera's, or upright with the lowest at 0
    std::vector<scan::Rgba8> colors;
    nlohmann::ordered_json report;
};

/// What one camera gives at one instant.
struct SessionPicture {
    std::size_t camera = 0;
    std::span<const float> depth;       ///< (pixels) metres, NaN or 0 where unknown
    std::span<const scan::Rgba8> color; ///< (pixels) or empty
};

/// \throw Error wherever nothing can be made of what was fed, saying why
class FusionSession {
  public:
    FusionSession(std::vector<scan::IntakeCamera> cameras, const SessionOptions& options,
                  RowLoop rows);

    /// Pictures of one instant.
    void add(std::span<const SessionPicture> instant);
    /// `progress(share)` may throw to stop.
    [[nodiscard]] SessionResult finish(const std::function<void(double)>& progress);

  private:
    struct Seen {
        scan::CameraView view;
        std::optional<geometry::Plane> floor; ///< in the camera's coordinates
    };
    [[nodiscard]] std::optional<Seen> use(const SessionPicture& picture);
    void keep(std::vector<Seen> instant);
    [[nodiscard]] bool several() const { return cameras_.size() > 1; }
    [[nodiscard]] SessionResult finish_one(const std::function<void(double)>& progress);
    [[nodiscard]] SessionResult finish_rig(const std::function<void(double)>& progress);

    std::vector<scan::Intake> cameras_;
    SessionOptions options_;
    RowLoop rows_;
    bool begun_ = false;                                   ///< once a frame shows something
    std::unique_ptr<scan::RigidFusion> fusion_;            ///< of one camera
    std::unique_ptr<scan::RigFusion> rig_;                 ///< of several
    std::vector<std::vector<std::vector<float>>> waiting_; ///< (cameras) to be averaged
    std::optional<geometry::Plane> floor_; ///< in the first camera's coordinates; several: world
    std::size_t fed_ = 0, empty_ = 0;
    std::string trouble_; ///< of the last frame that showed nothing
};

} // namespace toile::fusion_scanner
