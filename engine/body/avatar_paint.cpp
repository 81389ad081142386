#include "body/avatar_atlas.h"

#include <algorithm>
#include <cmath>

namespace toile::body {
namespace {

constexpr float kHemWidth = 0.010f; // from the edge to the stitches, metres
constexpr float kStitchWidth = 0.0014f;
constexpr float kThighShare = 0.34f; // of the thigh covered by the base layer
constexpr int kBleed = 8;            // texels

float distance_to_segment(const Vec3f& p, const Vec3f& a, const Vec3f& b) {
    const Vec3f ab = b - a;
    const float t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0f, 1.0f);
    return (p - a - t * ab).norm();
}

/// Coverage of a band around `centre` of half width `half`, softened over `soft`.
float band(float value, float centre, float half, float soft) {
    return std::clamp((half + 0.5f * soft - std::abs(value - centre)) / soft, 0.0f, 1.0f);
}

using Colour = Vec3f;

Colour to_colour(const std::array<std::uint8_t, 3>& tone) {
    return {static_cast<float>(tone[0]), static_cast<float>(tone[1]), static_cast<float>(tone[2])};
}

/// The colour at a point of the template; `texel` is the size of a texel there, metres.
Colour colour_at(const Skeleton& skeleton, const AvatarTones& tones, const Vec3f& p, float texel) {
    const float depth = base_layer_depth(skeleton, p);
    const float covered = std::clamp(0.5f + depth / texel, 0.0f, 1.0f);
    Colour layer = to_colour(tones.layer);
    const float stitch = band(depth, kHemWidth, 0.5f * kStitchWidth, texel);
    const float fold = band(depth, 0.0f, 0.5f * kStitchWidth, 1.5f * texel);
    layer *= 1.0f - 0.16f * stitch - 0.10f * fold;
    return (1.0f - covered) * to_colour(tones.skin) + covered * layer;
}

/// Spreads painted texels into their unpainted neighbours.
void bleed(imaging::Image& image, std::vector<bool>& painted) {
    const int n = image.width;
    for (int step = 0; step < kBleed; ++step) {
        std::vector<std::pair<std::size_t, std::size_t>> copies;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const auto i = static_cast<std::size_t>(y * n + x);
                if (painted[i]) continue;
                for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                    const int sx = x + dx, sy = y + dy;
                    if (sx < 0 || sy < 0 || sx >= n || sy >= n) continue;
                    const auto j = static_cast<std::size_t>(sy * n + sx);
                    if (!painted[j]) continue;
                    copies.emplace_back(i, j);
                    break;
                }
            }
        for (const auto& [to, from] : copies) {
            std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(4 * from), 4,
                        image.pixels.begin() + static_cast<std::ptrdiff_t>(4 * to));
            painted[to] = true;
        }
    }
}

} // namespace

float base_layer_depth(const Skeleton& skeleton, const Vec3f& p) {
    const Vec3f q(std::abs(p.x()), p.y(), p.z()); // the body is symmetric
    // Legs: down to a plane across the thigh.
    const Vec3f hip = skeleton.rest(Joint::left_upper_leg);
    const Vec3f thigh = skeleton.rest(Joint::left_lower_leg) - hip;
    const float leg = kThighShare * thigh.norm() - (q - hip).dot(thigh.normalized());
    // Armholes: a capsule from the shoulder down the arm.
    const Vec3f shoulder = skeleton.rest(Joint::left_upper_arm) + Vec3f(0.012f, 0.0f, 0.0f);
    const Vec3f hand = skeleton.rest(Joint::left_hand);
    const Vec3f beyond = hand + 0.5f * (hand - skeleton.rest(Joint::left_lower_arm)).normalized();
    const float arm =
        std::min(distance_to_segment(q, shoulder, hand), distance_to_segment(q, hand, beyond)) -
        0.088f;
    // Neckline: an elliptic scoop, deeper in front; nothing above the shoulders.
    const Vec3f neck = skeleton.rest(Joint::neck);
    const bool front = q.z() > neck.z();
    const Eigen::Array2f radii(0.088f, front ? 0.115f : 0.055f);
    const float above = std::max(neck.y() - 0.012f - q.y(), 0.0f);
    const Eigen::Array2f scaled = Eigen::Array2f(q.x(), above) / radii;
    const float scoop = (scaled.matrix().norm() - 1.0f) * radii.minCoeff();
    const float top = neck.y() + 0.035f - q.y();
    return std::min(std::min(leg, arm), std::min(scoop, top));
}

imaging::Image paint_base_layer(const AvatarTemplate& avatar, const geometry::SeamedLayout& layout,
                                const AvatarTones& tones, int texels) {
    imaging::Image image;
    image.width = image.height = texels;
    const auto count = static_cast<std::size_t>(texels) * static_cast<std::size_t>(texels);
    image.pixels.resize(4 * count);
    for (std::size_t i = 0; i < count; ++i) { // the gaps, seen by nobody
        for (std::size_t k = 0; k < 3; ++k)
            image.pixels[4 * i + k] = tones.skin[k];
        image.pixels[4 * i + 3] = 255;
    }
    std::vector<bool> painted(count);
    for (const auto& t : layout.triangles) {
        std::array<Vec2f, 3> uv;
        std::array<Vec3f, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            uv[k] = static_cast<float>(texels) * layout.texcoords[t[k]];
            p[k] = avatar.mesh.positions[layout.welded[t[k]]];
        }
        const Vec2f ab = uv[1] - uv[0], ac = uv[2] - uv[0];
        const float area = ab.x() * ac.y() - ab.y() * ac.x();
        if (area == 0.0f) continue;
        const float texel = std::sqrt((p[1] - p[0]).cross(p[2] - p[0]).norm() / std::abs(area));
        const auto low = [&](int k) {
            return std::max(
                0, static_cast<int>(std::floor(std::min({uv[0][k], uv[1][k], uv[2][k]}) - 1.0f)));
        };
        const auto high = [&](int k) {
            return std::min(texels - 1,
                            static_cast<int>(std::ceil(std::max({uv[0][k], uv[1][k], uv[2][k]}))));
        };
        for (int y = low(1); y <= high(1); ++y)
            for (int x = low(0); x <= high(0); ++x) {
                const Vec2f c(static_cast<float>(x) + 0.5f - uv[0].x(),
                              static_cast<float>(y) + 0.5f - uv[0].y());
                const float v = (c.x() * ac.y() - c.y() * ac.x()) / area;
                const float w = (ab.x() * c.y() - ab.y() * c.x()) / area;
                if (v < 0.0f || w < 0.0f || v + w > 1.0f) continue;
                const Vec3f point = (1.0f - v - w) * p[0] + v * p[1] + w * p[2];
                const Colour colour = colour_at(avatar.skeleton, tones, point, texel);
                const auto i = static_cast<std::size_t>(y * texels + x);
                for (std::size_t k = 0; k < 3; ++k)
                    image.pixels[4 * i + k] = static_cast<std::uint8_t>(
                        std::clamp(std::lround(colour[static_cast<int>(k)]), 0l, 255l));
                painted[i] = true;
            }
    }
    bleed(image, painted);
    return image;
}

} // namespace toile::body
