#include "scan/global_registration.h"

#include "geometry/point_tree.h"
#include "scan/rig_motion.h"

#include <cmath>

namespace toile::scan {

std::optional<GlobalRegistration> register_features(std::span<const Feature> a,
                                                    std::span<const Feature> b,
                                                    const GlobalOptions& options) {
    constexpr std::size_t kSample = 4; // P1 2.2 (3)
    std::vector<Vec3d> from, to;
    for (const Match& pair : match(a, b, options.descriptor, options.ratio)) {
        to.push_back(a[pair.a].point.cast<double>());
        from.push_back(b[pair.b].point.cast<double>());
    }
    const RigidFit fit = robust_motion(to, from, options.reach_m, options.draws, kSample);
    if (fit.inliers.size() < options.fewest) return std::nullopt;
    GlobalRegistration out;
    out.a_from_b = fit.a_from_b;
    out.matches = to.size();
    out.agreeing = fit.inliers.size();
    out.rms_m = fit.rms_m;
    return out;
}

Registered register_surfaces(const DepthView& a, const DepthView& b, const Pose& start,
                             float reach_m, const RowLoop& rows) {
    VolumeOptions coarse;
    coarse.voxel_m = 0.01f;
    coarse.truncation_m = 0.04f;
    // The volume's middle lies amid what `a` sees.
    Vec3d middle = Vec3d::Zero();
    double count = 0.0;
    for (int y = 0; y < a.camera.height; y += 2)
        for (int x = 0; x < a.camera.width; x += 2)
            if (a.depth[a.camera.at(x, y)] > 0.0f) {
                middle += a.point(x, y).cast<double>();
                count += 1.0;
            }
    Pose centred = Pose::Identity();
    if (count > 0.0) centred.translation() = -middle / count;
    Volume volume(Vec3f::Zero(), coarse);
    volume.integrate(a, centred, rows);
    Registered found;
    found.pose = centred * start;
    for (const float reach : {reach_m, 0.5f * reach_m, 0.03f}) {
        RegistrationOptions options;
        options.reach_m = reach;
        const SurfaceMap map = raycast(volume, b, 2, reach, found.pose, rows);
        found = register_view(b, map, found.pose, options, rows);
    }
    found.pose = centred.inverse() * found.pose;
    return found;
}

std::optional<GlobalRegistration> register_globally(const DepthView& a, const DepthView& b,
                                                    const GlobalOptions& options,
                                                    const RowLoop& rows) {
    constexpr float kReach_m = 0.08f;
    constexpr double kLeastOverlap = 0.3; // of the readings; a view from 30 degrees has 0.6
    const auto seen_a = find_features(a, options.descriptor, options.features);
    const auto seen_b = find_features(b, options.descriptor, options.features);
    auto out = register_features(seen_a, seen_b, options);
    if (!out) return out;
    const Registered settled = register_surfaces(a, b, out->a_from_b, kReach_m, rows);
    if (settled.overlap < kLeastOverlap) return std::nullopt;
    out->a_from_b = settled.pose;
    out->rms_m = settled.rms_m;
    out->overlap = settled.overlap;
    return out;
}

Registered register_clouds(std::span<const Vec3f> a, std::span<const Vec3f> b, const Pose& start,
                           double threshold, int rounds) {
    Registered out;
    out.pose = start;
    if (a.size() < 3 || b.size() < 3) return out;
    const geometry::PointTree tree(a);
    double before = std::numeric_limits<double>::max();
    for (int round = 0; round < rounds; ++round) {
        std::vector<Vec3d> to, from;
        double square = 0.0;
        for (const Vec3f& p : b) {
            const Vec3f here = (out.pose * p.cast<double>()).cast<float>();
            const Vec3f& near = a[tree.nearest(here).index];
            to.push_back(near.cast<double>());
            from.push_back(p.cast<double>());
            square += (near - here).cast<double>().squaredNorm();
        }
        out.pose = rigid_motion(to, from);
        const double mean = square / static_cast<double>(b.size());
        out.rms_m = std::sqrt(mean);
        if (std::abs(before - mean) < threshold) break;
        before = mean;
    }
    out.overlap = 1.0; // every point has a pair
    return out;
}

} // namespace toile::scan
