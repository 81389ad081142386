// Two views of one subject whose cameras may stand anywhere: points that look alike, a motion that
// most of them agree with, then the surfaces (P1 2.2).
#pragma once

#include "scan/features.h"
#include "scan/registration.h"

#include <optional>

namespace toile::scan {

struct GlobalOptions {
    FeatureOptions features;
    Descriptor descriptor = Descriptor::full;
    double ratio = 0.85;    ///< of the nearest to the second nearest description
    double reach_m = 0.03;  ///< of a match that agrees
    int draws = 20000;      ///< of four matches each (P1 2.2)
    std::size_t fewest = 8; ///< matches that must agree
};

struct GlobalRegistration {
    Pose a_from_b = Pose::Identity();
    std::size_t matches = 0, agreeing = 0;
    double rms_m = 0.0; ///< of the surfaces, along the normals, after the last step
    double overlap = 0.0;
};

/// From the features of two views: the motion that at least `fewest` matches agree with.
[[nodiscard]] std::optional<GlobalRegistration> register_features(std::span<const Feature> a,
                                                                  std::span<const Feature> b,
                                                                  const GlobalOptions& options);

/// The same, then point to plane. Nothing when too few points are alike, or the surfaces do not
/// meet.
[[nodiscard]] std::optional<GlobalRegistration> register_globally(const DepthView& a,
                                                                  const DepthView& b,
                                                                  const GlobalOptions& options,
                                                                  const RowLoop& rows);

/// Point to plane from a start that is nearly right: `b` against what `a` shows, wide pairs first.
[[nodiscard]] Registered register_surfaces(const DepthView& a, const DepthView& b,
                                           const Pose& start, float reach_m, const RowLoop& rows);

/// Plain ICP (P1 2.2 (4), eq. 5-7 with the norm's square): nearest points of two thinned clouds,
/// from `start`, until the mean square distance changes by less than `threshold` (metres squared).
[[nodiscard]] Registered register_clouds(std::span<const Vec3f> a, std::span<const Vec3f> b,
                                         const Pose& start, double threshold, int rounds);

} // namespace toile::scan
