#include "geometry/floor_plane.h"

#include "core/random.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace toile::geometry {
namespace {

constexpr int kTries = 300;
constexpr std::size_t kTestPoints = 4000;
constexpr float kOnPlane = 0.025f; // metres: of the floor
constexpr float kBelow = 0.06f;    // farther below the floor than this is not usual

} // namespace

std::vector<Vec3f> thinned_out(std::span<const Vec3f> points, std::size_t count) {
    std::vector<Vec3f> out;
    const std::size_t step = std::max<std::size_t>(1, points.size() / count);
    for (std::size_t i = 0; i < points.size(); i += step)
        out.push_back(points[i]);
    return out;
}

std::optional<Plane> best_plane(std::span<const Vec3f> points,
                                const std::function<bool(const Vec3f&)>& accept,
                                const std::function<double(const Plane&)>& score) {
    if (points.size() < 3) return std::nullopt;
    Random random(1);
    std::optional<Plane> best;
    double most = 0.0;
    for (int i = 0; i < kTries; ++i) {
        const auto pick = [&] {
            return points[static_cast<std::size_t>(
                random.uniform(0.0, static_cast<double>(points.size()) - 1e-6))];
        };
        const Vec3f a = pick(), b = pick(), c = pick();
        Vec3f normal = (b - a).cross(c - a);
        if (normal.norm() < 1e-4f) continue;
        normal.normalize();
        if (!accept(normal)) continue;
        const auto plane = Plane::through(a, normal);
        const double s = score(plane);
        if (s > most) most = s, best = plane;
    }
    return best;
}

Plane refined_plane(Plane plane, std::span<const Vec3f> points, float reach) {
    for (int round = 0; round < 4; ++round) {
        Vec3f mean = Vec3f::Zero();
        std::vector<Vec3f> on;
        for (const Vec3f& p : points)
            if (std::abs(plane.normal.dot(p) - plane.offset) < reach) {
                on.push_back(p);
                mean += p;
            }
        if (on.size() < 10) break;
        mean /= static_cast<float>(on.size());
        Mat3f covariance = Mat3f::Zero();
        for (const Vec3f& p : on)
            covariance += (p - mean) * (p - mean).transpose();
        Eigen::SelfAdjointEigenSolver<Mat3f> solver;
        solver.computeDirect(covariance);
        Vec3f normal = solver.eigenvectors().col(0).normalized();
        if (normal.dot(plane.normal) < 0.0f) normal = -normal;
        plane = Plane::through(mean, normal);
    }
    return plane;
}

std::optional<Plane> find_floor(std::span<const Vec3f> points, const Vec3f& up_hint,
                                float most_angle) {
    const auto test = thinned_out(points, kTestPoints);
    const float least = std::cos(most_angle);
    const auto count_on = [&](Plane plane) {
        if (plane.normal.dot(up_hint) < 0.0f) plane = {-plane.normal, -plane.offset};
        double on = 0.0, below = 0.0;
        for (const Vec3f& p : test) {
            const float height = plane.normal.dot(p) - plane.offset;
            on += std::abs(height) < kOnPlane ? 1.0 : 0.0;
            below += height < -kBelow ? 1.0 : 0.0;
        }
        return below > 0.02 * static_cast<double>(test.size()) ? 0.0 : on;
    };
    auto found = best_plane(
        test, [&](const Vec3f& n) { return std::abs(n.dot(up_hint)) > least; }, count_on);
    if (!found || count_on(*found) < 0.03 * static_cast<double>(test.size())) return std::nullopt;
    if (found->normal.dot(up_hint) < 0.0f) found = {{-found->normal, -found->offset}};
    return refined_plane(*found, test, kOnPlane);
}

std::optional<float> podium_top(const Plane& floor, std::span<const Vec3f> points) {
    constexpr float kBin_m = 0.01f, kHighest_m = 0.35f, kLegs_m = 0.6f;
    constexpr std::size_t kWindow = 3, kTops = 35, kBins = 60;
    constexpr double kTimesLegs = 5.0, kLeastShare = 0.08, kLeastSpread_m = 0.1, kLeastAbove = 0.25;
    std::array<std::size_t, kBins> counts{};
    const auto height = [&](const Vec3f& p) { return floor.normal.dot(p) - floor.offset; };
    for (const Vec3f& p : points) {
        const float h = height(p);
        if (h >= 0.0f && h < kLegs_m) ++counts[static_cast<std::size_t>(h / kBin_m)];
    }
    const auto all = static_cast<double>(points.size());
    const auto window = [&](std::size_t first) {
        return counts[first] + counts[first + 1] + counts[first + 2];
    };
    std::size_t best = 0;
    for (std::size_t b = 1; b + kWindow <= kTops; ++b)
        if (window(b) > window(best)) best = b;
    double legs = 0.0;
    for (std::size_t b = kTops; b < kBins; ++b)
        legs += static_cast<double>(kWindow * counts[b]) / static_cast<double>(kBins - kTops);
    const auto most = static_cast<double>(window(best));
    if (most < kTimesLegs * legs || most < kLeastShare * all) return {};
    std::size_t above = 0, count = 0;
    const float low = kBin_m * static_cast<float>(best);
    double heights = 0.0;
    Vec3d sum = Vec3d::Zero();
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    for (const Vec3f& p : points) {
        if (height(p) < low) continue;
        if (height(p) >= low + kWindow * kBin_m) {
            ++above;
            continue;
        }
        ++count;
        heights += static_cast<double>(height(p));
        sum += p.cast<double>();
        square += p.cast<double>() * p.cast<double>().transpose();
    }
    if (count == 0 || static_cast<double>(above) < kLeastAbove * all) return {};
    const auto n = static_cast<double>(count);
    const Vec3d middle = sum / n;
    const Eigen::Matrix3d spread = square / n - middle * middle.transpose();
    // The least of the three is across the top.
    if (Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues()[1] <
        kLeastSpread_m * kLeastSpread_m)
        return {};
    const auto out = static_cast<float>(heights / n);
    return out < kHighest_m ? std::optional(out) : std::nullopt;
}

} // namespace toile::geometry
