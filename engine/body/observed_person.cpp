#include "body/position_retarget.h"

#include <vector>

namespace toile::body {

namespace {

using enum Joint;

std::size_t index(Joint joint) {
    return static_cast<std::size_t>(joint);
}

/// Value below which `share` of the numbers lie; `fallback` when there are too few.
float quantile(std::vector<float> values, float share, float fallback) {
    if (values.size() < 3) return fallback;
    const auto n = static_cast<std::size_t>(share * static_cast<float>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
    return values[n];
}

float median(std::vector<float> values, float fallback) {
    return quantile(std::move(values), 0.5f, fallback);
}

bool tracked(const ObservedSkeleton& frame, Joint joint) {
    return frame.confidence[index(joint)] > 0.9f && frame.positions[index(joint)].allFinite();
}

/// Median length of a chain of bones over the frames that saw all of it.
float chain_length(std::span<const ObservedSkeleton> frames, std::span<const Joint> chain,
                   float fallback) {
    std::vector<float> lengths;
    for (const ObservedSkeleton& frame : frames) {
        float sum = 0.0f;
        bool all = tracked(frame, chain[0]);
        for (std::size_t i = 1; i < chain.size(); ++i) {
            all = all && tracked(frame, chain[i]);
            sum += (frame.positions[index(chain[i])] - frame.positions[index(chain[i - 1])]).norm();
        }
        if (all) lengths.push_back(sum);
    }
    return median(std::move(lengths), fallback);
}

float rest_length(const Skeleton& skeleton, std::span<const Joint> chain) {
    float sum = 0.0f;
    for (std::size_t i = 1; i < chain.size(); ++i)
        sum += (skeleton.rest(chain[i]) - skeleton.rest(chain[i - 1])).norm();
    return sum;
}

constexpr std::array kLeftLeg = {left_upper_leg, left_lower_leg, left_foot};
constexpr std::array kRightLeg = {right_upper_leg, right_lower_leg, right_foot};
constexpr std::array kTrunk = {hips, chest, upper_chest, neck};

/// Share of the frames in which both feet and knees were tracked.
float seen_share(std::span<const ObservedSkeleton> frames) {
    std::size_t count = 0;
    for (const ObservedSkeleton& frame : frames) {
        count += tracked(frame, left_foot) && tracked(frame, right_foot) &&
                 tracked(frame, left_lower_leg) && tracked(frame, right_lower_leg);
    }
    return static_cast<float>(count) / static_cast<float>(std::max<std::size_t>(frames.size(), 1));
}

/// Median of a unit direction from one point to another, in the chest's frame.
Vec3f median_direction(std::span<const ObservedSkeleton> frames, Joint from, Joint to,
                       const Vec3f& fallback) {
    std::array<std::vector<float>, 3> parts;
    for (const ObservedSkeleton& frame : frames) {
        const auto& p = frame.positions;
        const bool good = tracked(frame, from) && tracked(frame, to) && tracked(frame, chest) &&
                          tracked(frame, upper_chest) && tracked(frame, left_upper_arm) &&
                          tracked(frame, right_upper_arm);
        if (!good) continue;
        const Quatf trunk = frame_of(p[index(left_upper_arm)] - p[index(right_upper_arm)],
                                     p[index(upper_chest)] - p[index(chest)]);
        const Vec3f d = unit_or(trunk.conjugate() * (p[index(to)] - p[index(from)]), fallback);
        for (std::size_t k = 0; k < 3; ++k)
            parts[k].push_back(d[static_cast<Eigen::Index>(k)]);
    }
    const Vec3f d(median(parts[0], fallback.x()), median(parts[1], fallback.y()),
                  median(parts[2], fallback.z()));
    return unit_or(d, fallback);
}

/// Median distance by which the ankles are ahead of the hip joints, observed metres.
float ankle_ahead(std::span<const ObservedSkeleton> frames, float fallback) {
    std::vector<float> values;
    for (const ObservedSkeleton& frame : frames) {
        const auto& p = frame.positions;
        const Vec3f lateral = p[index(left_upper_arm)] - p[index(right_upper_arm)] +
                              p[index(left_upper_leg)] - p[index(right_upper_leg)];
        const Vec3f ahead = unit_or(lateral.cross(Vec3f::UnitY()), Vec3f::UnitZ());
        for (std::size_t side = 0; side < 2; ++side) {
            const Joint hip = side == 0 ? left_upper_leg : right_upper_leg;
            const Joint foot = side == 0 ? left_foot : right_foot;
            if (tracked(frame, hip) && tracked(frame, foot))
                values.push_back((p[index(foot)] - p[index(hip)]).dot(ahead));
        }
    }
    return median(std::move(values), fallback);
}

} // namespace

ObservedPerson measure_person(const Skeleton& skeleton, std::span<const ObservedSkeleton> frames) {
    ObservedPerson person;
    person.legs_seen = seen_share(frames) > 0.3f;

    const float trunk = rest_length(skeleton, kTrunk);
    const float by_trunk = trunk / chain_length(frames, kTrunk, trunk);
    person.scale = by_trunk;
    if (person.legs_seen) {
        const float leg = rest_length(skeleton, kLeftLeg);
        const float seen =
            0.5f * (chain_length(frames, kLeftLeg, leg) + chain_length(frames, kRightLeg, leg));
        person.scale = leg / seen;
    }
    person.scale = std::clamp(person.scale, 0.7f, 1.6f);

    std::vector<float> heights;
    for (const ObservedSkeleton& frame : frames)
        if (tracked(frame, hips)) heights.push_back(frame.positions[0].y());
    const float hip_drop = skeleton.rest(hips).y() - skeleton.rest(left_foot).y();
    person.hips_height = median(heights, 0.0f);
    const float below_hips = person.hips_height - hip_drop / person.scale;
    for (std::size_t side = 0; side < 2; ++side) {
        const Joint foot = side == 0 ? left_foot : right_foot;
        std::vector<float> ankles;
        for (const ObservedSkeleton& frame : frames)
            if (tracked(frame, foot)) ankles.push_back(frame.positions[index(foot)].y());
        person.ankle_height[side] =
            person.legs_seen ? quantile(ankles, 0.25f, below_hips) : below_hips;
    }
    // One floor under both feet: what differs more than a few centimetres is a raised foot.
    const float lower = std::min(person.ankle_height[0], person.ankle_height[1]);
    for (float& height : person.ankle_height)
        height = std::min(height, lower + 0.05f);

    if (person.legs_seen) {
        std::vector<float> leg_heights;
        for (const ObservedSkeleton& frame : frames) {
            if (!tracked(frame, left_upper_leg) || !tracked(frame, right_upper_leg)) continue;
            leg_heights.push_back(0.5f * (frame.positions[index(left_upper_leg)].y() +
                                          frame.positions[index(right_upper_leg)].y() -
                                          person.ankle_height[0] - person.ankle_height[1]));
        }
        const float rest = skeleton.rest(left_upper_leg).y() - skeleton.rest(left_foot).y();
        const float seen = person.scale * median(leg_heights, rest / person.scale);
        person.hips_raise = std::clamp(rest - seen, -0.04f, 0.06f);
    }
    if (person.legs_seen) {
        // Trackers see hips on the body's front and ankles at its back: stand people up straight.
        const float rest = skeleton.rest(left_foot).z() - skeleton.rest(left_upper_leg).z();
        const float seen = person.scale * ankle_ahead(frames, rest / person.scale);
        person.ankle_ahead = std::clamp(rest - seen, -0.15f, 0.15f);
    }

    for (std::size_t side = 0; side < 2; ++side) {
        const float sign = side == 0 ? 1.0f : -1.0f;
        Vec3f d = median_direction(frames, side == 0 ? left_shoulder : right_shoulder,
                                   side == 0 ? left_upper_arm : right_upper_arm,
                                   Vec3f(0.97f * sign, -0.22f, 0.0f));
        d.y() = std::clamp(d.y(), -0.5f, 0.0f);
        person.shoulder_direction[side] = d.normalized();
    }
    Vec3f d = median_direction(frames, neck, head, Vec3f(0.0f, 0.99f, 0.12f));
    d.x() = std::clamp(d.x(), -0.05f, 0.05f);
    d.z() = std::clamp(d.z(), -0.1f, 0.5f);
    person.neck_direction = d.normalized();
    return person;
}

} // namespace toile::body
