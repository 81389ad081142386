// A closed standing figure whose sections are known: ellipses along straight limbs.
#pragma once

#include "geometry/level_surface.h"
#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace toile::test {

/// By the complete elliptic integral: 4 a E(e), e the eccentricity.
inline double ellipse_perimeter(double a, double b) {
    const double major = std::max(a, b), minor = std::min(a, b);
    return 4.0 * major * std::comp_ellint_2(std::sqrt(1.0 - minor * minor / (major * major)));
}

/// A place along a limb and the half axes of its section there: across (x) and in depth (z; of a
/// limb along z, upwards).
struct Ring {
    float at;
    float x, z;
};

/// A straight body part: ellipses across an axis, their half axes following a smooth curve through
/// the rings (flat at each ring, so that the extremes lie there).
struct Limb {
    Vec3f from;
    Vec3f along; ///< unit; `at` of the rings is the distance from `from`
    std::vector<Ring> rings;

    /// Below 0 inside; exact where it is 0.
    [[nodiscard]] float value(const Vec3f& p) const {
        const float s = (p - from).dot(along);
        if (s < rings.front().at) return std::max(rings.front().at - s, 1e-4f);
        if (s > rings.back().at) return std::max(s - rings.back().at, 1e-4f);
        std::size_t i = 0;
        while (i + 2 < rings.size() && s > rings[i + 1].at)
            ++i;
        const Ring &low = rings[i], &high = rings[i + 1];
        const float t = (s - low.at) / (high.at - low.at);
        const float w = t * t * (3.0f - 2.0f * t);
        const float a = low.x + w * (high.x - low.x), b = low.z + w * (high.z - low.z);
        // A foot, which lies along z, has its depth upwards.
        const Vec3f ahead = std::abs(along.z()) > 0.9f ? Vec3f::UnitY() : Vec3f::UnitZ();
        const Vec3f depth = (ahead - ahead.dot(along) * along).normalized();
        const Vec3f across = along.cross(depth);
        const Vec3f off = p - from - s * along;
        const float side =
            (std::hypot(off.dot(across) / a, off.dot(depth) / b) - 1.0f) * std::min(a, b);
        // The flat ends count too, so that the surface closes exactly there.
        return std::max({side, rings.front().at - s, s - rings.back().at});
    }
};

/// 1.70 m tall, legs apart, arms 45 degrees off, facing +Z.
struct Mannequin {
    static constexpr float kStature = 1.70f, kCrotch = 0.80f;
    static constexpr Ring kHip{0.90f, 0.170f, 0.125f}, kWaist{1.07f, 0.125f, 0.090f},
        kBust{1.25f, 0.150f, 0.125f}, kNeck{0.10f, 0.056f, 0.056f}, kCalf{0.30f, 0.055f, 0.055f},
        kShin{0.12f, 0.032f, 0.032f}, kWrist{0.56f, 0.027f, 0.022f};

    std::vector<Limb> limbs;

    Mannequin() {
        const Vec3f up = Vec3f::UnitY();
        limbs.push_back({Vec3f::Zero(),
                         up,
                         {{kCrotch, 0.160f, 0.105f},
                          kHip,
                          kWaist,
                          {1.19f, 0.145f, 0.105f},
                          kBust,
                          {1.36f, 0.145f, 0.085f},
                          {1.42f, 0.060f, 0.060f}}});
        limbs.push_back(
            {Vec3f(0, 1.38f, 0), up, {{0, 0.07f, 0.07f}, kNeck, {0.16f, 0.06f, 0.07f}}});
        limbs.push_back({Vec3f(0, 1.47f, 0.01f),
                         up,
                         {{0, 0.05f, 0.06f},
                          {0.11f, 0.075f, 0.095f},
                          {0.20f, 0.055f, 0.07f},
                          {0.23f, 0.01f, 0.01f}}});
        for (const float side : {1.0f, -1.0f}) {
            const Vec3f ankle(side * 0.10f, 0.0f, 0.0f);
            limbs.push_back({ankle,
                             up,
                             {{0, 0.04f, 0.05f},
                              {0.05f, 0.036f, 0.05f},
                              kShin,
                              kCalf,
                              {0.44f, 0.050f, 0.050f},
                              {0.80f, 0.085f, 0.095f},
                              {0.86f, 0.080f, 0.090f}}});
            limbs.push_back({ankle - Vec3f(0, 0.0f, 0.07f),
                             Vec3f::UnitZ(),
                             {{0, 0.03f, 0.02f}, {0.10f, 0.04f, 0.05f}, {0.24f, 0.04f, 0.02f}}});
            limbs.push_back({Vec3f(side * 0.12f, 1.34f, 0.0f),
                             Vec3f(side, -1.0f, 0.0f).normalized(),
                             {{0, 0.055f, 0.055f},
                              {0.10f, 0.052f, 0.052f},
                              {0.30f, 0.040f, 0.040f},
                              {0.37f, 0.043f, 0.040f},
                              kWrist,
                              {0.64f, 0.018f, 0.045f},
                              {0.74f, 0.008f, 0.01f}}});
        }
        // Feet are not below the floor.
        for (Limb& limb : limbs)
            if (limb.along.z() > 0.5f) limb.from.y() += 0.03f;
    }

    [[nodiscard]] float value(const Vec3f& p) const {
        float least = std::numeric_limits<float>::max();
        for (const Limb& limb : limbs)
            least = std::min(least, limb.value(p));
        return std::max(least, -p.y());
    }

    [[nodiscard]] geometry::TriangleMesh mesh(float spacing) const {
        const geometry::TriangleMesh all{
            {Vec3f(-0.75f, -0.01f, -0.2f), Vec3f(0.75f, 1.72f, 0.25f), Vec3f(0.0f, 0.5f, 0.0f)},
            {},
            {{0, 1, 2}}};
        return geometry::level_surface(
            all, spacing, [](const Vec3f&) { return 0.01f; },
            [this](const Vec3f& p) { return value(p); });
    }
};

} // namespace toile::test
