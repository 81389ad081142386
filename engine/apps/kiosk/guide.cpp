#include "apps/kiosk/guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::apps::kiosk {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kWithin = 28.0f * kPi / 180.0f;
constexpr double kSteady_s = 0.35;
constexpr std::array kOrder = {Side::front, Side::left, Side::back, Side::right};

// About +Y, from facing the camera.
float angle_of(Side side) {
    switch (side) {
    case Side::left:
        return 0.5f * kPi;
    case Side::back:
        return kPi;
    case Side::right:
        return -0.5f * kPi;
    default:
        return 0.0f;
    }
}

float wrapped(float angle) {
    return std::remainder(angle, 2.0f * kPi);
}

// One limb or the trunk of the figure: a tube between two places.
struct Tube {
    Vec3f from;
    Vec3f to;
    float half_width; // x at rest
    float half_depth; // z
};

constexpr float kArmOut = 0.17f;
const std::array<Tube, 8> kFigure = {{
    {{0.0f, 0.93f, 0.0f}, {0.0f, 1.42f, 0.0f}, 0.17f, 0.11f},
    {{0.0f, 1.45f, 0.02f}, {0.0f, 1.52f, 0.02f}, 0.05f, 0.05f},
    {{-0.09f, 0.06f, 0.0f}, {-0.09f, 0.92f, 0.0f}, 0.075f, 0.08f},
    {{0.09f, 0.06f, 0.0f}, {0.09f, 0.92f, 0.0f}, 0.075f, 0.08f},
    {{-0.19f, 1.38f, 0.0f}, {-0.19f - kArmOut, 0.92f, 0.03f}, 0.045f, 0.045f},
    {{0.19f, 1.38f, 0.0f}, {0.19f + kArmOut, 0.92f, 0.03f}, 0.045f, 0.045f},
    {{-0.09f, 0.03f, 0.0f}, {-0.09f, 0.03f, 0.16f}, 0.045f, 0.04f},
    {{0.09f, 0.03f, 0.0f}, {0.09f, 0.03f, 0.16f}, 0.045f, 0.04f},
}};

} // namespace

std::optional<Side> side_shown(const pipeline::BodyFrame& frame, const Vec3f& eye) {
    const float* r = frame.joints[0].rotation;
    const float* p = frame.joints[0].position;
    const Vec3f forward = Quatf(r[3], r[0], r[1], r[2]) * Vec3f::UnitZ();
    const Vec3f to_eye = eye - Vec3f(p[0], p[1], p[2]);
    const float turned =
        wrapped(std::atan2(forward.x(), forward.z()) - std::atan2(to_eye.x(), to_eye.z()));
    for (const Side side : kOrder)
        if (std::abs(wrapped(turned - angle_of(side))) < kWithin) return side;
    return std::nullopt;
}

void Turn::begin() {
    erase();
}

void Turn::see(const pipeline::BodyFrame& frame, const Vec3f& eye,
               const pipeline::SensorFrame& pictures, double dt_s) {
    const Side side = side_shown(frame, eye).value_or(Side::invalid);
    shown_s_ = side == showing_ ? shown_s_ + dt_s : 0.0;
    showing_ = side;
    if (side == Side::invalid || has(side) || shown_s_ < kSteady_s) return;
    kept_[static_cast<std::size_t>(side)] = pictures;
}

bool Turn::has(Side side) const {
    return kept_[static_cast<std::size_t>(side)].has_value();
}

bool Turn::complete() const {
    return std::all_of(kOrder.begin(), kOrder.end(), [this](Side s) { return has(s); });
}

Side Turn::wanted() const {
    for (const Side side : kOrder)
        if (!has(side)) return side;
    return Side::front;
}

std::vector<pipeline::SensorFrame> Turn::take() {
    std::vector<pipeline::SensorFrame> out;
    for (const Side side : kOrder) {
        auto& kept = kept_[static_cast<std::size_t>(side)];
        if (kept) out.push_back(std::move(*kept));
        kept.reset();
    }
    showing_ = Side::invalid;
    shown_s_ = 0.0;
    return out;
}

void Turn::erase() {
    for (auto& kept : kept_) {
        if (!kept) continue;
        std::fill(kept->depth.metres.begin(), kept->depth.metres.end(), 0.0f);
        std::fill(kept->color.pixels.begin(), kept->color.pixels.end(), std::uint8_t{0});
        kept.reset();
    }
    showing_ = Side::invalid;
    shown_s_ = 0.0;
}

void draw_guide(render::Canvas& canvas, const render::Rect& place, Side wanted, double seconds) {
    // Two seconds of turning to the side, two of standing there, and again from the front.
    const auto t = static_cast<float>(std::fmod(seconds, 4.0));
    const float way = std::clamp(t / 2.0f, 0.0f, 1.0f);
    const float eased = way * way * (3.0f - 2.0f * way);
    const float turn = wanted == Side::front ? 0.25f * std::sin(static_cast<float>(seconds))
                                             : eased * angle_of(wanted);
    const float metre = place.height / 1.9f;
    const Vec2f foot(place.centre().x(), place.y + place.height - 0.1f * metre);
    const float c = std::cos(turn);
    const float s = std::sin(turn);
    // The figure is seen as in a mirror, a little from above.
    const auto seen = [&](const Vec3f& p) {
        const float x = -(c * p.x() + s * p.z());
        const float z = -s * p.x() + c * p.z();
        return Vec2f(foot.x() + metre * x, foot.y() - metre * (p.y() - 0.16f * z));
    };
    std::array<Vec2f, 49> disc; // the turntable, seen from a little above
    for (std::size_t i = 0; i < disc.size(); ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / 48.0f;
        disc[i] = foot + metre * Vec2f(0.36f * std::cos(angle), 0.07f * std::sin(angle));
    }
    canvas.line(disc, {255, 255, 255, 90}, 0.014f * metre);
    std::array<std::size_t, kFigure.size()> order{};
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    const auto depth = [&](std::size_t i) {
        const Vec3f m = 0.5f * (kFigure[i].from + kFigure[i].to);
        return -s * m.x() + c * m.z();
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return depth(a) < depth(b); });
    for (const std::size_t i : order) {
        const Tube& tube = kFigure[i];
        const float half = std::hypot(c * tube.half_width, s * tube.half_depth);
        const auto light =
            static_cast<std::uint8_t>(std::clamp(212.0f + 160.0f * depth(i), 150.0f, 255.0f));
        const render::Ink ink{light, light, light, 255};
        const Vec2f a = seen(tube.from);
        const Vec2f b = seen(tube.to);
        const std::array<Vec2f, 2> ends = {a, b};
        canvas.line(ends, ink, 2.0f * half * metre);
        canvas.disc(a, half * metre, ink);
        canvas.disc(b, half * metre, ink);
    }
    const Vec2f head = seen({0.0f, 1.64f, 0.02f});
    canvas.disc(head, 0.105f * metre, {235, 235, 235, 255});
    // A nose tells front from back.
    if (c > -0.2f) canvas.disc(seen({0.0f, 1.63f, 0.13f}), 0.022f * metre, {150, 150, 150, 255});
}

} // namespace toile::apps::kiosk
