// Many views of one rigid subject, whose cameras' places are not known, to one surface: a moving
// camera, or a subject that turns before a fixed one (P1 2.3).
#pragma once

#include "scan/closing.h"
#include "scan/depth_filter.h"
#include "scan/registration.h"

#include <functional>
#include <map>
#include <memory>

namespace toile::scan {

struct FusionOptions {
    bool close_loop = true;     ///< spread what is missing when the turn comes round
    bool refine_jointly = true; ///< all views at once, after the loop
    int bias_rounds = 2;        ///< what smoothing took off is put back, then fused again
    FilterOptions filter;       ///< that the views were made with
    float voxel_m = 0.005f;     ///< of the surface
    float truncation_m = 0.015f;
    double pair_angle = 1.1; ///< lines of sight of views that are registered to each other, radians
    std::size_t pairs = 8;   ///< of each view
    int smoothing_rounds = 1; ///< of the surface, at the size of its voxels
};

struct FusionReport {
    std::size_t frames = 0, lost_frames = 0;
    double turn_rad = 0.0; ///< how far the lines of sight went round
    bool loop_closed = false;
    double loop_gap_m = 0.0;    ///< what the chain of frames had missed the start by
    double loop_error_m = 0.0;  ///< and what is left of it
    double joint_rms_m = 0.0;   ///< between views, along the normals
    double surface_rms_m = 0.0; ///< of the readings from the surface
    std::size_t dropped_pieces = 0;
    double guessed_share = 0.0; ///< of the surface: where nothing was seen
};

struct FusedSurface {
    geometry::TriangleMesh mesh; ///< in the first camera's coordinates
    std::vector<Rgba8> colors;   ///< (nv), or empty
    std::vector<Pose> poses;     ///< first camera from each camera; of the frames that were used
    std::vector<std::uint32_t> frames; ///< their numbers
    FusionReport report;
};

/// Feed views in order, then `finish` once.
class RigidFusion {
  public:
    RigidFusion(const FusionOptions& options, RowLoop rows);
    ~RigidFusion();
    RigidFusion(const RigidFusion&) = delete;
    RigidFusion& operator=(const RigidFusion&) = delete;

    /// Places a view against what was seen before; one that does not fit is lost and counted.
    /// `likely`: the first camera from this one as something else tells: where what was seen before
    /// does not fit, it is tried from there, and taken as it is if it could be a turn so far.
    void add(DepthView view, const std::optional<Pose>& likely = std::nullopt);
    /// Places a view where its camera is known to stand: the first camera from this one.
    void add_at(DepthView view, const Pose& first_from_camera);
    [[nodiscard]] std::size_t count() const { return views_.size(); }

    /// The loop closed and all views placed at once: by their numbers, the first camera from each.
    /// Nothing may be added after; `finish` goes on from there.
    [[nodiscard]] std::map<std::uint32_t, Pose> settled();

    /// `progress(share)` may throw to stop. `floor`: in the first camera's coordinates.
    /// \throw Error when nothing was seen, or but one view
    [[nodiscard]] FusedSurface finish(const std::optional<geometry::Plane>& floor,
                                      const std::function<void(double)>& progress);

  private:
    void begin(const DepthView& first);
    void keep(DepthView view, const Pose& pose, std::uint32_t number);
    [[nodiscard]] Registered tracked(const DepthView& view) const;
    [[nodiscard]] Registered registered(const DepthView& view, const Pose& start,
                                        float reach) const;
    [[nodiscard]] bool can_have_turned_to(const Pose& pose, std::uint32_t number) const;
    void close_loop();
    void settle();
    [[nodiscard]] double surface_rms(const Volume& volume) const;
    void take_off_bias();
    [[nodiscard]] Volume fused(std::span<const std::size_t> which, float voxel,
                               float truncation) const;
    [[nodiscard]] std::vector<std::size_t> all() const;
    [[nodiscard]] double gap(std::size_t late, Pose& correction) const;

    FusionOptions options_;
    RowLoop rows_;
    std::vector<DepthView> views_;
    std::vector<Pose> poses_; ///< scan from camera; the scan's origin lies amid the subject
    std::vector<std::uint32_t> numbers_;
    Pose first_ = Pose::Identity(); ///< scan from the first camera
    std::unique_ptr<Volume> model_; ///< of the tracking, coarse
    std::uint32_t fed_ = 0;
    bool settled_ = false;
    FusionReport report_;
};

} // namespace toile::scan
