// Where cameras stand: point-to-plane registration against a surface, and of many views at once.
#pragma once

#include "scan/volume.h"

namespace toile::scan {

struct RegistrationOptions {
    float reach_m = 0.08f; ///< pairs farther apart are no pairs
    float angle = 0.8f;    ///< most between their normals, radians
    int rounds = 12;
    int stride = 2; ///< every so many pixels
};

struct Registered {
    Pose pose = Pose::Identity();
    double rms_m = 0.0;   ///< of the pairs, along the normals
    double overlap = 0.0; ///< share of the readings that found a pair
};

/// One view against what the volume shows from `start` (P1 2.3: raycast prediction). The step that
/// the pairs leave open (as along an even wall) stays zero.
[[nodiscard]] Registered register_view(const DepthView& view, const SurfaceMap& map,
                                       const Pose& start, const RegistrationOptions& options,
                                       const RowLoop& rows);

/// A view, and where its camera is fixed among others.
struct RigView {
    const DepthView* view = nullptr;
    Pose rig_from_camera = Pose::Identity();
};

/// Views of one instant, each against its own map, all moved as one: `start` and the result are the
/// scan from the rig.
[[nodiscard]] Registered register_rig(std::span<const RigView> views,
                                      std::span<const SurfaceMap> maps, const Pose& start,
                                      const RegistrationOptions& options, const RowLoop& rows);

/// One view against the distances of the volume itself: for small corrections.
[[nodiscard]] Registered settle_view(const DepthView& view, const Volume& volume, const Pose& start,
                                     const RegistrationOptions& options, const RowLoop& rows);

/// Two views that see the same places.
struct ViewPair {
    std::uint32_t a = 0, b = 0;
};

struct JointOptions {
    float reach_m = 0.03f;
    float angle = 0.6f;
    int rounds = 20;
    int stride = 4;
    double huber_m = 0.006; ///< residuals beyond this count linearly
};

/// Moves all views but the first so that the readings of each pair lie on each other's tangent
/// planes, all pairs at once. Returns the rms along the normals, metres.
double register_jointly(std::span<const DepthView> views, std::span<const ViewPair> pairs,
                        const JointOptions& options, std::vector<Pose>& poses, const RowLoop& rows);

/// Pairs of views whose lines of sight differ by less than `most_angle` (radians): of each view
/// the next one, and about `count` others spread evenly over that range.
[[nodiscard]] std::vector<ViewPair> overlapping_pairs(std::span<const Pose> poses,
                                                      double most_angle, std::size_t count);

} // namespace toile::scan
