// A closed standing figure whose sections are known: ellipses along straight limbs.
#pragma once

#include "geometry/level_surface.h"
#include "geometry/mesh.h"
#include "support/ellipse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace toile::test {

/// A place along a limb; the half axes of its section there, across and in depth; and how far the
/// section's middle lies ahead of the limb's axis. Metres.
struct Ring {
    float at;
    float across, depth;
    float ahead = 0.0f;
};

/// A piece of a limb with one section from end to end: its girth is the same wherever in it a tape
/// is laid. Between two places along the limb.
struct Stretch {
    float from, to;
    float across, depth;
    float ahead = 0.0f;

    [[nodiscard]] double girth() const {
        return ellipse_perimeter(static_cast<double>(across), static_cast<double>(depth));
    }
};

/// A straight body part: ellipses across an axis, their half axes and middles following a smooth
/// curve through the rings (flat at each ring, so that the extremes lie there).
struct Limb {
    Vec3f from;
    Vec3f along; ///< unit; `at` of the rings is the distance from `from`
    std::vector<Ring> rings = {};

    static Limb between(const Vec3f& from, const Vec3f& to) {
        return {from, (to - from).normalized()};
    }
    Limb& ring(const Ring& one) {
        rings.push_back(one);
        return *this;
    }
    Limb& stretch(const Stretch& s) {
        return ring({s.from, s.across, s.depth, s.ahead}).ring({s.to, s.across, s.depth, s.ahead});
    }

    /// The middle of its section at a place within a stretch.
    [[nodiscard]] Vec3f middle(const Stretch& s, float at) const {
        return from + at * along + s.ahead * depth();
    }

    /// Across the axis: towards +Z, of a foot (which lies along it) upwards.
    [[nodiscard]] Vec3f depth() const {
        const Vec3f ahead = std::abs(along.z()) > 0.9f ? Vec3f::UnitY() : Vec3f::UnitZ();
        return (ahead - ahead.dot(along) * along).normalized();
    }

    /// Below 0 inside; exact where it is 0.
    [[nodiscard]] float value(const Vec3f& p) const {
        const float s = (p - from).dot(along);
        std::size_t i = 0;
        while (i + 2 < rings.size() && s > rings[i + 1].at)
            ++i;
        const Ring &low = rings[i], &high = rings[i + 1];
        const float t = std::clamp((s - low.at) / (high.at - low.at), 0.0f, 1.0f);
        const float w = t * t * (3.0f - 2.0f * t);
        const auto between = [w](float a, float b) { return a + w * (b - a); };
        const float a = between(low.across, high.across), b = between(low.depth, high.depth);
        const Vec3f up = depth();
        const Vec3f off = p - from - s * along - between(low.ahead, high.ahead) * up;
        const float side =
            (std::hypot(off.dot(along.cross(up)) / a, off.dot(up) / b) - 1.0f) * std::min(a, b);
        // Flat ends.
        return std::max({side, rings.front().at - s, s - rings.back().at});
    }
};

/// 1.70 m tall, facing +Z, in the pose and of about the build of the mean adult (avatars/adult), so
/// that a body fitted to it hardly bends: what is measured at rest is then what stands here. Places
/// on the trunk are heights.
struct Mannequin {
    static constexpr float kCrotch = 0.82f;
    static constexpr Stretch kHip{0.89f, 0.96f, 0.180f, 0.123f, 0.018f},
        kWaist{1.06f, 1.11f, 0.145f, 0.108f, 0.048f}, kBust{1.20f, 1.26f, 0.158f, 0.122f, 0.040f},
        kNeck{-0.01f, 0.05f, 0.057f, 0.059f}, kHead{0.11f, 0.16f, 0.075f, 0.097f},
        kThigh{0.10f, 0.17f, 0.097f, 0.100f}, kCalf{0.09f, 0.16f, 0.061f, 0.061f, -0.022f},
        kShin{0.33f, 0.37f, 0.031f, 0.040f, -0.006f}, kUpperArm{0.14f, 0.20f, 0.046f, 0.050f},
        kWrist{0.235f, 0.275f, 0.024f, 0.029f};

    std::vector<Limb> limbs;

    Mannequin() {
        limbs = {trunk(), neck(), head()};
        for (const float side : {1.0f, -1.0f})
            limbs.insert(limbs.end(),
                         {thigh(side), shin(side), foot(side), upper_arm(side), lower_arm(side)});
    }

    static Limb trunk() {
        return Limb{Vec3f::Zero(), Vec3f::UnitY()}
            .ring({kCrotch, 0.165f, 0.105f, 0.030f})
            .stretch(kHip)
            .stretch(kWaist)
            .stretch(kBust)
            .ring({1.34f, 0.170f, 0.100f, 0.016f})
            .ring({1.39f, 0.150f, 0.075f, 0.008f})
            .ring({1.425f, 0.065f, 0.055f, 0.012f});
    }
    static Limb neck() {
        return Limb::between(Vec3f(0, 1.441f, 0.024f), Vec3f(0, 1.537f, 0.061f))
            .ring({-0.05f, 0.07f, 0.05f})
            .stretch(kNeck)
            .ring({0.09f, 0.057f, 0.07f});
    }
    static Limb head() {
        return Limb{Vec3f(0, 1.475f, 0.055f), Vec3f::UnitY()}
            .ring({0.0f, 0.045f, 0.060f, 0.02f})
            .ring({0.05f, 0.065f, 0.090f, 0.01f})
            .stretch(kHead)
            .ring({0.20f, 0.055f, 0.070f})
            .ring({0.225f, 0.015f, 0.02f});
    }

    /// side: 1 the left one, -1 the right one.
    static Limb thigh(float side) {
        return Limb::between(Vec3f(side * 0.101f, 0.905f, 0.030f),
                             Vec3f(side * 0.147f, 0.473f, 0.038f))
            .ring({0.03f, 0.040f, 0.070f})
            .stretch(kThigh)
            .ring({0.36f, 0.071f, 0.071f})
            .ring({0.45f, 0.061f, 0.062f});
    }
    static Limb shin(float side) {
        return Limb::between(Vec3f(side * 0.153f, 0.473f, 0.038f),
                             Vec3f(side * 0.199f, 0.073f, 0.016f))
            .ring({-0.02f, 0.061f, 0.062f})
            .ring({0.03f, 0.058f, 0.059f, -0.012f})
            .stretch(kCalf)
            .stretch(kShin)
            .ring({0.41f, 0.033f, 0.055f});
    }
    static Limb foot(float side) {
        return Limb{Vec3f(side * 0.19f, 0.03f, -0.055f), Vec3f::UnitZ()}
            .ring({0.0f, 0.028f, 0.025f})
            .ring({0.09f, 0.038f, 0.050f})
            .ring({0.26f, 0.035f, 0.020f});
    }
    static Limb upper_arm(float side) {
        return Limb::between(Vec3f(side * 0.196f, 1.346f, 0.018f),
                             Vec3f(side * 0.375f, 1.155f, 0.027f))
            .ring({-0.08f, 0.025f, 0.040f})
            .ring({-0.02f, 0.048f, 0.055f})
            .ring({0.08f, 0.050f, 0.055f})
            .stretch(kUpperArm)
            .ring({0.27f, 0.043f, 0.042f});
    }
    static Limb lower_arm(float side) {
        return Limb::between(Vec3f(side * 0.375f, 1.155f, 0.027f),
                             Vec3f(side * 0.54f, 0.975f, 0.09f))
            .ring({-0.01f, 0.043f, 0.042f})
            .ring({0.06f, 0.042f, 0.040f})
            .stretch(kWrist)
            .ring({0.31f, 0.022f, 0.042f})
            .ring({0.36f, 0.014f, 0.042f})
            .ring({0.43f, 0.006f, 0.012f});
    }

    [[nodiscard]] float value(const Vec3f& p) const {
        float least = std::numeric_limits<float>::max();
        for (const Limb& limb : limbs)
            least = std::min(least, limb.value(p));
        return std::max(least, -p.y());
    }

    /// Its vertices lie on the figure, `spacing` metres apart.
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
