// Frames of one camera to the surface of the rigid subject that it goes around, or that turns.
#pragma once

#include "scan/fusion.h"

#include <deque>
#include <nlohmann/json.hpp>

namespace toile::fusion_scanner {

struct SessionOptions {
    scan::FilterOptions filter;
    scan::FusionOptions fusion;
    bool choose_radius = true; ///< rougher readings are smoothed more widely
    int averaged_frames = 1;   ///< of so many frames in a row one picture is made
};

struct SessionCamera {
    imaging::Intrinsics intrinsics;
    std::optional<Eigen::Isometry3d> world_from_camera;
};

struct SessionResult {
    geometry::TriangleMesh mesh; ///< in the world: the camera's, or upright with the lowest at 0
    std::vector<scan::Rgba8> colors;
    nlohmann::ordered_json report;
};

/// \throw Error wherever nothing can be made of what was fed, saying why
class FusionSession {
  public:
    FusionSession(SessionCamera camera, const SessionOptions& options, RowLoop rows);

    /// `depth` (pixels) metres, NaN or 0 where unknown; `color` (pixels) or empty.
    void add(std::span<const float> depth, std::span<const scan::Rgba8> color);
    /// `progress(share)` may throw to stop.
    [[nodiscard]] SessionResult finish(const std::function<void(double)>& progress);

  private:
    void use(std::span<const float> depth, std::span<const scan::Rgba8> color);
    [[nodiscard]] Vec3f up() const;
    [[nodiscard]] Eigen::Isometry3d upright(const geometry::TriangleMesh& mesh) const;

    SessionCamera camera_;
    SessionOptions options_;
    RowLoop rows_;
    std::unique_ptr<scan::RigidFusion> fusion_; ///< once the first frame shows something
    std::vector<std::vector<float>> waiting_;   ///< to be averaged
    std::optional<geometry::Plane> floor_;      ///< in the first camera's coordinates
    std::size_t fed_ = 0, empty_ = 0;
    std::string trouble_; ///< of the last frame that showed nothing
};

} // namespace toile::fusion_scanner
