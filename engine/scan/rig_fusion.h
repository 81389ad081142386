// Pictures of several cameras that are fixed to each other, to one surface: they stand around a
// subject (P1: four Kinects), or see parts of it that turns before them (P2: three Kinects).
#pragma once

#include "scan/fusion.h"

namespace toile::scan {

/// What one camera of a rig sees at one instant.
struct CameraView {
    std::uint32_t camera = 0;
    DepthView view;
};

/// How far places of cameras may be corrected by what all of them see (rotation about the first
/// camera, standard deviations). Zero: not at all.
struct CameraFreedom {
    double turn_rad = 0.0, shift_m = 0.0;
};

struct RigReport {
    std::size_t instants = 0, lost_instants = 0;
    double turn_rad = 0.0;        ///< how far the subject turned before the rig
    double views_rms_m = 0.0;     ///< between views, along the normals
    double cameras_moved_m = 0.0; ///< the most that a camera's place was corrected
};

struct RigSystem;
struct Sums;

/// Feed instants in order, `place` once or not at all, then `finish` once.
class RigFusion {
  public:
    /// `world_from_camera`: where each camera stands.
    RigFusion(const FusionOptions& options, std::vector<Pose> world_from_camera, RowLoop rows);
    ~RigFusion();
    RigFusion(const RigFusion&) = delete;
    RigFusion& operator=(const RigFusion&) = delete;

    /// Pictures of one instant, of the cameras that see the subject; all are placed together
    /// against what was seen before. What does not fit is lost and counted, and false.
    bool add(std::vector<CameraView> instant);

    /// Places all instants at once, and the cameras as far as they are free; the first camera
    /// stays. \throw Error when nothing was seen
    void place(const CameraFreedom& freedom);

    /// As corrected by `place`.
    [[nodiscard]] const std::vector<Pose>& world_from_camera() const { return cameras_; }
    /// Of the instants that were kept: where the subject's own coordinates are.
    [[nodiscard]] const std::vector<Pose>& scan_from_world() const { return instants_; }
    [[nodiscard]] const RigReport& report() const { return report_; }

    /// In the world, as the subject stood in the first instant. `floor`: in the world. `progress`
    /// may throw to stop. \throw Error when nothing was seen
    [[nodiscard]] FusedSurface finish(const std::optional<geometry::Plane>& floor,
                                      const std::function<void(double)>& progress);

  private:
    void keep(std::vector<CameraView> instant, const Pose& scan_from_world);
    [[nodiscard]] bool fits(const Registered& found) const;
    [[nodiscard]] Registered tracked(std::span<const RigView> views) const;
    [[nodiscard]] std::vector<ViewPair> pairs(std::span<const Pose> poses) const;
    [[nodiscard]] Pose pose_of(std::size_t view) const {
        return instants_[instant_of_[view]] * cameras_[camera_of_[view]];
    }
    [[nodiscard]] RigSystem gathered(std::span<const ViewPair> pairs, std::span<const Sums> sums,
                                     bool free) const;
    void hold(const CameraFreedom& freedom, RigSystem& system) const;
    double step(std::span<const ViewPair> pairs, const JointOptions& options,
                const CameraFreedom& freedom, double& longest);

    FusionOptions options_;
    RowLoop rows_;
    std::vector<Pose> cameras_, told_; ///< world from camera; as told at first
    std::vector<Pose> instants_;       ///< scan from world; the scan's origin lies amid the subject
    std::vector<DepthView> views_;
    std::vector<std::uint32_t> camera_of_, instant_of_; ///< (views)
    std::unique_ptr<Volume> model_;
    double last_rms_m_ = 0.0; ///< of the last instant that was kept, against the model
    std::size_t missed_ = 0;  ///< instants that were lost since the last one that was kept
    std::size_t gap_ = 1;     ///< instants from the last but one that was kept to the last
    RigReport report_;
};

} // namespace toile::scan
