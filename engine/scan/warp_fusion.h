// Many views of a subject that moved in itself to one surface, as it was in the first of them:
// a person who sways, breathes and moves the arms while turning (P2).
#pragma once

#include "scan/closing.h"
#include "scan/depth_filter.h"
#include "scan/joint_warp.h"
#include "scan/moving_subject.h"
#include "scan/part_registration.h"

#include <functional>

namespace toile::scan {

struct WarpFusionOptions {
    std::size_t nodes = 60; ///< of the deformation graph (P2: 50 to 60)
    int rounds = 10;        ///< at most, of registration
    JointWarpOptions joint; ///< its reach is where the rounds begin
    float end_reach_m = 0.015f;
    double pair_angle = 1.1; ///< lines of sight of views that are registered to each other, radians
    std::size_t pairs = 6;   ///< of each view
    BindingOptions binding;
    FilterOptions filter; ///< that the views were made with
    int bias_rounds = 2;
    float voxel_m = 0.005f;
    float truncation_m = 0.015f;
    float disc_m = 0.009f; ///< radius of what a reading tells of
    int smoothing_rounds = 1;
    /// A template whose median distance from the readings is less tells what nobody saw; one that
    /// wears clothes does not.
    double likely_m = 0.008;
};

/// For people who move their limbs: parts are registered first, again and again (P4).
struct PartStage {
    std::vector<BodyGroup> groups; ///< (nv) of the template; empty: no such stage
    PartRegistrationOptions options;
    int iterations = 6; ///< at most: it ends when the residual falls no more
    float residual_reach_m = 0.05f;
};

struct WarpFusionReport {
    std::vector<JointWarpRound> rounds;
    std::vector<double> residuals_m; ///< before the limbs were followed, after it, each iteration
    std::size_t parts_left_out = 0;  ///< of views
    std::size_t limbs_astray = 0;    ///< of views: far from a template that elsewhere is near
    double beside_share = 0.0;       ///< of the readings: more than 4 cm off such a template
    bool carried_left_out = false;   ///< since that is too little for wide clothes
    double bound_share = 0.0;        ///< of the readings: near the template
    double largest_move_m = 0.0;     ///< of a node beside the template's own motion
    double loop_gap_m = 0.0;   ///< rms along the normals between the last views and the first ones,
    double loop_error_m = 0.0; ///< before and after registration
    double surface_rms_m = 0.0;  ///< of the readings from the surface
    double template_off_m = 0.0; ///< median distance of the readings from the template
    std::size_t dropped_pieces = 0;
    double guessed_share = 0.0;
};

struct WarpedSurface {
    geometry::TriangleMesh mesh; ///< in the first view's camera's coordinates
    std::vector<Rgba8> colors;   ///< (nv), or empty
    WarpFusionReport report;
};

/// A template and where it went.
struct MovingTemplate {
    geometry::TriangleMesh shape; ///< closed, before the first view's camera
    TemplatePoses poses;          ///< the first view's among them
    WholeMotion whole;            ///< of the views where it is known, or empty
};

/// `views`: in the order of time, the first is the one whose pose the surface takes. `floor`: in
/// the first view's camera's coordinates, normal up. `progress(share)` may throw to stop.
/// \throw Error for fewer than two views, or when nothing lies near the template
[[nodiscard]] WarpedSurface fuse_warped(std::vector<NumberedView> views, const MovingTemplate& body,
                                        const std::optional<geometry::Plane>& floor,
                                        const WarpFusionOptions& options, const PartStage& parts,
                                        const RowLoop& rows,
                                        const std::function<void(double)>& progress);

} // namespace toile::scan
