#include "body/leg_finder.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

constexpr int kLevels = 250;          // over the stature
constexpr float kPrecision = 0.0003f; // of the crotch's height, of the stature
constexpr float kTurns = 0.006f;      // share by which a girth must turn to make a peak or a hollow

/// The outlines that carry on a section of the trunk, hands beside it left out.
std::vector<Outline> parts_below(const Sections& sections, const Outline& trunk, float y) {
    std::vector<Outline> out;
    const Vec2f margin = 0.1f * (trunk.high - trunk.low);
    for (Outline& o : sections.at(y)) {
        const bool beneath = (o.centroid.array() >= (trunk.low - margin).array()).all() &&
                             (o.centroid.array() <= (trunk.high + margin).array()).all();
        if (beneath && o.area > 0.15 * trunk.area) out.push_back(std::move(o));
    }
    return out;
}

/// The section of the trunk to start from: round the body's middle, or above it.
Outline trunk_section(const Sections& sections, const Vec3f& middle, float step) {
    for (float y = middle.y(); y < sections.top() - 0.1f * sections.stature(); y += step)
        for (Outline& o : sections.at(y))
            if (o.contains(Vec2f(middle.x(), middle.z()))) return std::move(o);
    throw Error("the body has no trunk: it must stand upright, head up");
}

FoundLeg follow_leg(const Sections& sections, Outline top, float y, float step) {
    FoundLeg out;
    while (true) {
        out.heights.push_back(y);
        out.sections.push_back(std::move(top));
        y -= step;
        if (y <= sections.floor()) return out;
        top = sections.follow(out.sections.back(), y);
    }
}

Profile girths(const FoundLeg& leg) {
    Profile out;
    for (std::size_t i = 0; i < leg.sections.size(); ++i)
        out.add(leg.heights[i], static_cast<float>(leg.sections[i].girth()));
    return out;
}

/// How far the front of the leg stands out.
Profile fronts(const FoundLeg& leg) {
    Profile out;
    for (std::size_t i = 0; i < leg.sections.size(); ++i)
        out.add(leg.heights[i], leg.sections[i].high.y());
    return out;
}

Profile reversed(Profile p) {
    std::reverse(p.at.begin(), p.at.end());
    std::reverse(p.value.begin(), p.value.end());
    return p;
}

/// From the ankle up: the calf is the first peak of the girth, the lower knee the hollow above it.
void find_knee(FoundLeg& leg, float stature) {
    constexpr float kAround = 0.07f; // of the stature: where the knee cap may stand out
    const Profile up = reversed(girths(leg).between(leg.heights.front(), leg.thinnest));
    leg.lower_knee = leg.thinnest + 0.45f * (leg.heights.front() - leg.thinnest);
    leg.knee_trust = 0.3;
    if (const auto calf = up.first_peak(kTurns)) {
        const Profile above = up.between(up.at[*calf], up.at.back());
        if (const auto hollow = above.first_hollow(kTurns)) {
            leg.lower_knee = above.at[*hollow];
            leg.knee_trust = 0.7;
        }
    }
    const Profile front =
        fronts(leg).between(leg.lower_knee - kAround * stature, leg.lower_knee + kAround * stature);
    // The knee cap lies between its upper edge, which stands out, and the hollow beneath it.
    const float hollow = leg.lower_knee, bump = std::max(hollow, front.at[front.corner_above()]);
    leg.knee = hollow + 0.65f * (bump - hollow);
    leg.lower_knee = hollow + 0.2f * (bump - hollow);
}

void find_ankle(FoundLeg& leg, const Sections& sections) {
    constexpr float kSole = 0.03f; // of the stature: what is lower belongs to the foot
    const float floor = sections.floor();
    const float low = floor + kSole * sections.stature();
    const Profile girth = girths(leg).between(low, 0.5f * (leg.heights.front() + floor));
    leg.thinnest = girth.at[girth.smallest()];
    // The ankle bones, which hardly show, lie between there and the floor.
    leg.ankle = floor + 0.62f * (leg.thinnest - floor);
}

/// The farthest point of the foot from the ankle, seen from above.
void find_toe(FoundLeg& leg, const FoundLeg& other, const Sections& sections, float step) {
    const Vec2f ankle = leg.near(leg.thinnest).centroid;
    const Vec2f beside = other.near(other.thinnest).centroid;
    float most = 0.0f;
    leg.toe = ankle;
    for (float y = leg.thinnest; y > sections.floor(); y -= step)
        for (const Outline& o : sections.at(y)) {
            if ((o.centroid - ankle).norm() > (o.centroid - beside).norm()) continue;
            for (const Vec3f& p : o.points) {
                const float d = (Vec2f(p.x(), p.z()) - ankle).norm();
                if (d <= most || d > 0.25f * sections.stature()) continue;
                most = d;
                leg.toe = Vec2f(p.x(), p.z());
            }
        }
}

} // namespace

const Outline& FoundLeg::near(float y) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < heights.size(); ++i)
        if (std::abs(heights[i] - y) < std::abs(heights[best] - y)) best = i;
    return sections[best];
}

FoundLegs find_legs(const Sections& sections, const Vec3f& middle) {
    const float step = sections.stature() / kLevels;
    FoundLegs out;
    out.seat = trunk_section(sections, middle, step);

    // Down to where the trunk parts in two of like size.
    std::vector<Outline> parts;
    float y = out.seat.points.front().y();
    while (true) {
        y -= step;
        if (y <= sections.floor() + 0.1f * sections.stature())
            throw Error("the legs cannot be told apart: the body must stand with its feet apart "
                        "and nothing around both legs");
        parts = parts_below(sections, out.seat, y);
        if (parts.size() >= 2 && parts[1].area > 0.4 * parts[0].area) break;
        if (parts.empty()) throw Error("the body has a gap at a height of " + std::to_string(y));
        out.seat = std::move(parts.front());
    }
    const Outline above = out.seat;
    const float crotch =
        join_level(y, above.points.front().y(), kPrecision * sections.stature(),
                   [&](float level) { return parts_below(sections, above, level).size() < 2; });
    const float just_below = crotch - kPrecision * sections.stature();
    parts = parts_below(sections, above, just_below);
    const auto [a, b] = nearest_points(parts[0], parts[1]);
    out.crotch = Vec3f(0.5f * (a.x() + b.x()), crotch, 0.5f * (a.z() + b.z()));
    out.seat = sections.follow(above, crotch + kPrecision * sections.stature());

    if (parts[0].centroid.x() < parts[1].centroid.x()) std::swap(parts[0], parts[1]);
    for (std::size_t i = 0; i < 2; ++i) {
        out.legs[i] = follow_leg(sections, parts[i], just_below, step);
        find_ankle(out.legs[i], sections);
        find_knee(out.legs[i], sections.stature());
    }
    for (std::size_t i = 0; i < 2; ++i)
        find_toe(out.legs[i], out.legs[1 - i], sections, step);
    return out;
}

} // namespace toile::body
