// Small rotations' toolbox of the retargeting: frames, swings, twists, filters. All noexcept.
#pragma once

#include "core/types.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::body {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kDegree = kPi / 180.0f;

/// `fallback` where v has no length.
[[nodiscard]] inline Vec3f unit_or(const Vec3f& v, const Vec3f& fallback) noexcept {
    const float n = v.norm();
    return n > 1e-6f ? Vec3f(v / n) : fallback;
}

/// Part of v across the unit vector `axis`.
[[nodiscard]] inline Vec3f across(const Vec3f& v, const Vec3f& axis) noexcept {
    return v - v.dot(axis) * axis;
}

[[nodiscard]] inline Quatf about(const Vec3f& unit_axis, float angle) noexcept {
    return Quatf(Eigen::AngleAxisf(angle, unit_axis));
}

/// Shortest rotation from one unit vector to another.
[[nodiscard]] Quatf swing(const Vec3f& from, const Vec3f& to) noexcept;

/// Axes of a frame whose y is `up` and whose x is as near to `lateral` as that allows.
[[nodiscard]] inline Quatf frame_of(const Vec3f& lateral, const Vec3f& up) noexcept {
    Mat3f m;
    m.col(1) = unit_or(up, Vec3f::UnitY());
    m.col(0) = unit_or(across(lateral, m.col(1)), m.col(1).unitOrthogonal());
    m.col(2) = m.col(0).cross(m.col(1));
    return Quatf(m).normalized();
}

/// Angle in (-pi, pi] from a to b about the unit vector `axis`; both across it.
[[nodiscard]] inline float signed_angle(const Vec3f& a, const Vec3f& b,
                                        const Vec3f& axis) noexcept {
    return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

[[nodiscard]] inline float wrap_angle(float a) noexcept {
    return std::remainder(a, 2.0f * kPi);
}

/// `q` with its angle held to `limit`, shortest way.
[[nodiscard]] inline Quatf limit_angle(const Quatf& q, float limit) noexcept {
    const float half = std::atan2(q.vec().norm(), std::abs(q.w()));
    if (2.0f * half <= limit) return q;
    return Quatf::Identity().slerp(limit / (2.0f * half), q);
}

/// Rotation of a vector of small angles.
[[nodiscard]] inline Quatf from_rotation_vector(const Vec3f& v) noexcept {
    const float angle = v.norm();
    return angle > 1e-9f ? about(v / angle, angle) : Quatf::Identity();
}

/// Shortest rotation vector of q (radians).
[[nodiscard]] inline Vec3f rotation_vector(const Quatf& q) noexcept {
    const float s = q.vec().norm();
    if (s < 1e-9f) return Vec3f::Zero();
    const float sign = q.w() < 0.0f ? -1.0f : 1.0f;
    return q.vec() * (sign * 2.0f * std::atan2(s, std::abs(q.w())) / s);
}

/// Share of the way to a target in `dt` with time constant `tau`, seconds.
[[nodiscard]] inline float approach(float dt, float tau) noexcept {
    return 1.0f - std::exp(-dt / tau);
}

[[nodiscard]] inline float smooth_step(float low, float high, float x) noexcept {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// One-Euro filter of a point (Casiez 2012): little lag when fast, little jitter when slow.
/// Its lag is 1 / (2 pi cutoff), cutoff = minimum_hz + slope * speed.
class PointFilter {
  public:
    struct Options {
        float minimum_hz = 2.5f;
        float slope = 4.0f;    ///< Hz per m/s
        float speed_hz = 2.0f; ///< cutoff of the speed's own filter
    };
    void reset() noexcept { started_ = false; }
    [[nodiscard]] bool started() const noexcept { return started_; }
    [[nodiscard]] const Vec3f& value() const noexcept { return value_; }

    const Vec3f& update(const Vec3f& point, float dt, const Options& options) noexcept {
        if (!started_ || dt <= 0.0f) {
            if (!started_) value_ = point, speed_.setZero();
            started_ = true;
            return value_;
        }
        const Vec3f speed = (point - last_or(point)) / dt;
        speed_ += approach(dt, 1.0f / (2.0f * kPi * options.speed_hz)) * (speed - speed_);
        const float cutoff = options.minimum_hz + options.slope * speed_.norm();
        value_ += approach(dt, 1.0f / (2.0f * kPi * cutoff)) * (point - value_);
        last_ = point;
        has_last_ = true;
        return value_;
    }

  private:
    [[nodiscard]] const Vec3f& last_or(const Vec3f& point) const noexcept {
        return has_last_ ? last_ : point;
    }
    Vec3f value_ = Vec3f::Zero();
    Vec3f last_ = Vec3f::Zero();
    Vec3f speed_ = Vec3f::Zero();
    bool started_ = false;
    bool has_last_ = false;
};

} // namespace toile::body
