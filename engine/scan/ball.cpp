#include "scan/ball.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::scan {
namespace {

constexpr std::size_t kFewest = 30; // readings
constexpr int kCore = 2;            // pixels around a reading that must go on with it

/// Pixels with even neighbours all around, so that a stick or thread falls off what it holds.
std::vector<std::uint8_t> cores(const imaging::Intrinsics& camera, std::span<const float> depth) {
    std::vector<std::uint8_t> out(depth.size(), 0);
    const int w = camera.width, h = camera.height;
    for (int y = kCore; y < h - kCore; ++y)
        for (int x = kCore; x < w - kCore; ++x) {
            const float z = depth[static_cast<std::size_t>(y * w + x)];
            if (!(z > 0.0f)) continue;
            const float jump = 1.5f * depth_jump(z);
            bool even = true;
            for (int v = -kCore; v <= kCore && even; ++v)
                for (int u = -kCore; u <= kCore && even; ++u)
                    even =
                        std::abs(depth[static_cast<std::size_t>((y + v) * w + x + u)] - z) < jump;
            out[static_cast<std::size_t>(y * w + x)] = even ? 1 : 0;
        }
    return out;
}

struct Blob {
    std::vector<std::uint32_t> pixels;
    int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;

    void add(std::uint32_t at, int width) {
        pixels.push_back(at);
        const int x = static_cast<int>(at) % width, y = static_cast<int>(at) / width;
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
    }
    /// A disc fills pi / 4 of a square.
    [[nodiscard]] bool round() const {
        const double w = right - left + 1, h = bottom - top + 1;
        const double filled = static_cast<double>(pixels.size()) / (w * h);
        return pixels.size() >= kFewest && w < 1.35 * h && h < 1.35 * w && filled > 0.64 &&
               filled < 0.93;
    }
};

std::vector<Blob> blobs(const imaging::Intrinsics& camera, std::span<const float> depth) {
    std::vector<std::uint8_t> core = cores(camera, depth);
    std::vector<Blob> out;
    std::vector<std::uint32_t> open;
    for (std::uint32_t seed = 0; seed < core.size(); ++seed) {
        if (core[seed] == 0) continue;
        Blob blob;
        open.assign(1, seed);
        core[seed] = 0;
        while (!open.empty()) {
            const std::uint32_t at = open.back();
            open.pop_back();
            blob.add(at, camera.width);
            // Cores lie off the picture's rim, so that all four neighbours are in it.
            for (const std::uint32_t to :
                 {at - 1, at + 1, at - static_cast<std::uint32_t>(camera.width),
                  at + static_cast<std::uint32_t>(camera.width)})
                if (core[to] != 0 && std::abs(depth[to] - depth[at]) < depth_jump(depth[at])) {
                    core[to] = 0;
                    open.push_back(to);
                }
        }
        if (blob.round()) out.push_back(std::move(blob));
    }
    return out;
}

/// Distance along the ray at which a ball is met; nothing where it passes by.
std::optional<double> met(const Vec3d& ray, const Vec3d& centre, double radius) {
    const double b = ray.dot(centre), c = centre.squaredNorm() - radius * radius;
    const double root = b * b - c;
    if (root <= 0.0) return std::nullopt;
    return b - std::sqrt(root);
}

} // namespace

std::optional<Ball> fit_ball(std::span<const Vec3f> points, const Ball& start, bool radius_known) {
    constexpr int kRounds = 30;
    constexpr double kInner = 0.9; // of the radius: beyond it rays graze
    Ball ball = start;
    for (int round = 0; round < kRounds; ++round) {
        Eigen::Matrix4d h = Eigen::Matrix4d::Zero();
        Eigen::Vector4d g = Eigen::Vector4d::Zero();
        double square = 0.0;
        std::size_t count = 0;
        const double sigma = depth_sigma(static_cast<float>(ball.centre.norm()));
        for (const Vec3f& point : points) {
            const Vec3d p = point.cast<double>();
            const double distance = p.norm();
            const Vec3d ray = p / distance;
            const double past = ray.cross(ball.centre).norm();
            if (past > kInner * ball.radius_m) continue;
            const auto hit = met(ray, ball.centre, ball.radius_m);
            if (!hit) continue;
            const double residual = distance - *hit;
            if (std::abs(residual) > 5.0 * sigma + 0.1 * ball.radius_m) continue;
            // The hit moves with the centre along the normal, by 1 / cosine of the incidence.
            const Vec3d normal = (*hit * ray - ball.centre) / ball.radius_m;
            const double cosine = -normal.dot(ray);
            Eigen::Vector4d row;
            row << normal / cosine, 1.0 / cosine; // of -hit by centre and radius
            if (radius_known) row[3] = 0.0;
            const double w = std::min(1.0, 2.0 * sigma / std::max(1e-9, std::abs(residual)));
            h += w * row * row.transpose();
            g += w * residual * row;
            square += w * residual * residual;
            ++count;
        }
        if (count < kFewest) return std::nullopt;
        if (radius_known) h(3, 3) = 1.0;
        const Eigen::Vector4d step = -h.ldlt().solve(g);
        if (!step.allFinite() || step.head<3>().norm() > ball.radius_m) return std::nullopt;
        ball.rms_m = std::sqrt(square / static_cast<double>(count));
        ball.readings = count;
        ball.centre += step.head<3>();
        if (!radius_known) ball.radius_m += step[3];
        if (!(ball.radius_m > 0.01 && ball.radius_m < 1.0)) return std::nullopt;
        if (step.norm() < 1e-6) return ball;
    }
    return ball;
}

std::optional<FoundBall> find_ball(const imaging::Intrinsics& camera, std::span<const float> depth,
                                   const BallOptions& options) {
    const imaging::DepthUnprojector unprojector(camera);
    std::vector<Vec3f> points(depth.size());
    std::optional<FoundBall> best;
    double best_score = 0.0;
    bool unprojected = false;
    for (const Blob& blob : blobs(camera, depth)) {
        if (!unprojected) unprojector.points(depth, points), unprojected = true;
        Vec3d middle = Vec3d::Zero();
        for (const std::uint32_t at : blob.pixels)
            middle += points[at].cast<double>() / static_cast<double>(blob.pixels.size());
        const double wide = 0.25 * ((blob.right - blob.left) + (blob.bottom - blob.top)) + kCore;
        Ball start;
        const bool known = options.radius_m > 0.0;
        const double seen = wide * -middle.z() / camera.fx;
        start.radius_m = known ? options.radius_m : seen;
        if (known ? std::abs(seen - options.radius_m) > 0.35 * options.radius_m + 0.01
                  : seen < 0.8 * options.least_radius_m || seen > 1.2 * options.most_radius_m)
            continue;
        // Of a ball's readings the mean lies two thirds of the radius before its centre.
        start.centre = middle + 0.67 * start.radius_m * middle.normalized();
        std::vector<Vec3f> near;
        const int grow = kCore + 2;
        for (int y = std::max(0, blob.top - grow);
             y <= std::min(camera.height - 1, blob.bottom + grow); ++y)
            for (int x = std::max(0, blob.left - grow);
                 x <= std::min(camera.width - 1, blob.right + grow); ++x) {
                const Vec3f& p = points[static_cast<std::size_t>(y * camera.width + x)];
                if (p.allFinite() && p.z() < 0.0f) near.push_back(p);
            }
        const auto ball = fit_ball(near, start, known);
        if (!ball || ball->radius_m < (known ? 0.0 : options.least_radius_m) ||
            (!known && ball->radius_m > options.most_radius_m))
            continue;
        // As even as the camera's own noise, and full: its readings fill the disc.
        const double sigma = depth_sigma(static_cast<float>(-ball->centre.z()));
        const double pixels =
            std::numbers::pi * 0.81 * std::pow(camera.fx * ball->radius_m / -ball->centre.z(), 2.0);
        const double full = static_cast<double>(ball->readings) / pixels;
        if (ball->rms_m > 2.0 * sigma + 0.002 || full < 0.75) continue;
        const double score = full * std::sqrt(pixels) / (1.0 + ball->rms_m / sigma);
        if (score > best_score) best = FoundBall{*ball, std::move(near)}, best_score = score;
    }
    return best;
}

} // namespace toile::scan
