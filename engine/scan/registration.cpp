#include "scan/normal_equations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace toile::scan {
namespace {

/// Gauss-Newton over the readings of views whose cameras are fixed to each other; pair(k, p, n,
/// ...) adds the pair of a reading of view k, if any. `p` and `n` in the scan's coordinates.
template <class Pair>
Registered descend(std::span<const RigView> views, const Pose& start,
                   const RegistrationOptions& options, const RowLoop& rows, const Pair& pair) {
    constexpr std::uint32_t kGrain = 8;
    Registered out;
    out.pose = start;
    for (int round = 0; round < options.rounds; ++round) {
        Sums all;
        for (std::size_t k = 0; k < views.size(); ++k) {
            const DepthView& view = *views[k].view;
            const Eigen::Isometry3f pose = (out.pose * views[k].rig_from_camera).cast<float>();
            const auto lines = static_cast<std::uint32_t>(
                (view.camera.height + options.stride - 1) / options.stride);
            std::vector<Sums> parts((lines + kGrain - 1) / kGrain);
            rows(lines, kGrain, [&](std::uint32_t begin, std::uint32_t end) {
                for (std::uint32_t line = begin; line < end; ++line)
                    for (int x = 0; x < view.camera.width; x += options.stride) {
                        const int y = static_cast<int>(line) * options.stride;
                        const std::size_t i = view.camera.at(x, y);
                        if (view.depth[i] == 0.0f || view.weight[i] <= 0.0f) continue;
                        Sums& sums = parts[line / kGrain];
                        ++sums.readings;
                        pair(k, pose * view.point(x, y), pose.linear() * view.normals[i],
                             view.weight[i], round, sums);
                    }
            });
            for (const Sums& part : parts)
                all += part;
        }
        if (all.pairs < 50) return out;
        out.rms_m = std::sqrt(all.square / all.weight);
        out.overlap = static_cast<double>(all.pairs) / static_cast<double>(all.readings);
        const Vector6 step = solved(all.h, all.g);
        out.pose = moved(motion(step), out.pose);
        if (step.head<3>().norm() < 2e-5 && step.tail<3>().norm() < 2e-5) break;
    }
    return out;
}

} // namespace

Registered register_rig(std::span<const RigView> views, std::span<const SurfaceMap> maps,
                        const Pose& start, const RegistrationOptions& options,
                        const RowLoop& rows) {
    std::vector<Eigen::Isometry3f> camera_from_scan;
    for (const RigView& view : views)
        camera_from_scan.push_back((start * view.rig_from_camera).inverse().cast<float>());
    const float least_cosine = std::cos(options.angle);
    return descend(
        views, start, options, rows,
        [&](std::size_t k, const Vec3f& p, const Vec3f& n, float weight, int round, Sums& sums) {
            // The pairs become closer as the pose becomes better.
            const float reach =
                options.reach_m * std::max(0.25f, 1.0f - 0.12f * static_cast<float>(round));
            const SurfaceMap& map = maps[k];
            int x = 0, y = 0;
            if (!map.camera.pixel(camera_from_scan[k] * p, x, y)) return;
            const Vec3f& q = map.points[map.camera.at(x, y)];
            const Vec3f& m = map.normals[map.camera.at(x, y)];
            if (!(q.x() == q.x()) || (p - q).squaredNorm() > reach * reach ||
                m.dot(n) < least_cosine)
                return;
            sums.add(p, m, m.dot(p - q), weight, 0.25 * reach);
        });
}

Registered register_view(const DepthView& view, const SurfaceMap& map, const Pose& start,
                         const RegistrationOptions& options, const RowLoop& rows) {
    const RigView alone{&view, Pose::Identity()};
    return register_rig({&alone, 1}, {&map, 1}, start, options, rows);
}

Registered settle_view(const DepthView& view, const Volume& volume, const Pose& start,
                       const RegistrationOptions& options, const RowLoop& rows) {
    const float least_cosine = std::cos(options.angle);
    const RigView alone{&view, Pose::Identity()};
    return descend({&alone, 1}, start, options, rows,
                   [&](std::size_t, const Vec3f& p, const Vec3f& n, float weight, int, Sums& sums) {
                       float distance = 0.0f;
                       Vec3f slope;
                       if (!volume.sample(p, distance, slope) || slope.dot(n) < least_cosine ||
                           std::abs(distance) > options.reach_m)
                           return;
                       sums.add(p, slope, distance, weight, 0.01);
                   });
}

namespace {

/// Readings of `from`, seen by `to`.
Sums pair_sums(const DepthView& from, const DepthView& to, const Pose& to_from, const Pose& scan_to,
               const JointOptions& options) {
    Sums sums;
    const Eigen::Isometry3f move = to_from.cast<float>(), out = scan_to.cast<float>();
    const float least_cosine = std::cos(options.angle), reach = options.reach_m * options.reach_m;
    for (int y = options.stride / 2; y < from.camera.height; y += options.stride)
        for (int x = options.stride / 2; x < from.camera.width; x += options.stride) {
            const std::size_t i = from.camera.at(x, y);
            if (from.depth[i] == 0.0f || from.weight[i] <= 0.0f) continue;
            const Vec3f p = move * from.point(x, y);
            int u = 0, v = 0;
            if (!to.camera.pixel(p, u, v)) continue;
            const std::size_t j = to.camera.at(u, v);
            if (to.depth[j] == 0.0f || to.weight[j] <= 0.0f) continue;
            const Vec3f q = to.point(u, v);
            const Vec3f n = move.linear() * from.normals[i];
            if ((p - q).squaredNorm() > reach || n.dot(to.normals[j]) < least_cosine) continue;
            // The mean of both normals: the pair's plane is the same from either side.
            const Vec3f normal = (n + to.normals[j]).normalized();
            const double weight = std::sqrt(from.weight[i] * to.weight[j]);
            sums.add(out * p, out.linear() * normal, normal.dot(p - q), weight, options.huber_m);
        }
    return sums;
}

} // namespace

Sums mutual_sums(const DepthView& a, const DepthView& b, const Pose& scan_a, const Pose& scan_b,
                 const JointOptions& options) {
    const Pose b_from_a = scan_b.inverse() * scan_a;
    Sums sums = pair_sums(a, b, b_from_a, scan_b, options);
    Sums other = pair_sums(b, a, b_from_a.inverse(), scan_a, options);
    other.g = -other.g; // there the second view's readings move
    return sums += other;
}

double register_jointly(std::span<const DepthView> views, std::span<const ViewPair> pairs,
                        const JointOptions& options, std::vector<Pose>& poses,
                        const RowLoop& rows) {
    const auto n = static_cast<Eigen::Index>(6 * views.size());
    double rms = 0.0;
    for (int round = 0; round < options.rounds; ++round) {
        std::vector<Sums> sums(pairs.size());
        rows(static_cast<std::uint32_t>(pairs.size()), 1,
             [&](std::uint32_t begin, std::uint32_t end) {
                 for (std::uint32_t k = begin; k < end; ++k) {
                     const auto [a, b] = pairs[k];
                     sums[k] = mutual_sums(views[a], views[b], poses[a], poses[b], options);
                 }
             });
        Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(n);
        double square = 0.0, weight = 0.0;
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            const Eigen::Index a = 6 * pairs[k].a, b = 6 * pairs[k].b;
            h.block<6, 6>(a, a) += sums[k].h;
            h.block<6, 6>(b, b) += sums[k].h;
            h.block<6, 6>(a, b) -= sums[k].h;
            h.block<6, 6>(b, a) -= sums[k].h;
            g.segment<6>(a) += sums[k].g;
            g.segment<6>(b) -= sums[k].g;
            square += sums[k].square;
            weight += sums[k].weight;
        }
        rms = weight > 0.0 ? std::sqrt(square / weight) : 0.0;
        // The first view stays; views that nothing holds stay too.
        h.topLeftCorner(6, 6).diagonal().array() += 1e9;
        h.diagonal().array() += 1e-6 * std::max(1.0, h.diagonal().tail(n - 6).mean());
        const Eigen::VectorXd step = -h.ldlt().solve(g);
        if (!step.allFinite()) break;
        for (std::size_t i = 1; i < views.size(); ++i)
            poses[i] = moved(motion(step.segment<6>(static_cast<Eigen::Index>(6 * i))), poses[i]);
        if (step.lpNorm<Eigen::Infinity>() < 2e-5) break;
    }
    return rms;
}

std::vector<ViewPair> overlapping_pairs(std::span<const Pose> poses, double most_angle,
                                        std::size_t count) {
    std::vector<ViewPair> out;
    const double least = std::cos(most_angle);
    for (std::uint32_t a = 0; a < poses.size(); ++a) {
        std::vector<std::uint32_t> near;
        for (std::uint32_t b = a + 1; b < poses.size(); ++b)
            if (poses[a].linear().col(2).dot(poses[b].linear().col(2)) > least) near.push_back(b);
        const std::size_t step =
            std::max<std::size_t>(1, (near.size() + count / 2) / std::max<std::size_t>(1, count));
        for (std::size_t k = 0; k < near.size(); k += step)
            out.push_back({a, near[k]});
    }
    return out;
}

} // namespace toile::scan
