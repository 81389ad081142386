#include "body/body_volumes.h"

#include "body/rotations.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::body {

namespace {

constexpr std::size_t kAngles = TrunkProfile::kAngles;
constexpr std::size_t kSlices = TrunkProfile::kSlices;

std::size_t index(Joint joint) {
    return static_cast<std::size_t>(joint);
}

float angle_bin(float x, float z) noexcept {
    const float turns = std::atan2(z, x) / (2.0f * kPi);
    return (turns < 0.0f ? turns + 1.0f : turns) * static_cast<float>(kAngles);
}

bool is_trunk(Part part) {
    return part == Part::torso || part == Part::pelvis;
}

/// Axis of one slice: middle of the extent, moved back so that what is inside goes out in front.
Vec2f slice_axis(std::span<const Vec2f> points) {
    Eigen::AlignedBox2f box;
    for (const Vec2f& p : points)
        box.extend(p);
    const Vec2f centre = box.center();
    return {0.0f, centre.y() - 0.15f * box.sizes().y()};
}

/// Largest radius per angle; angles without a vertex take the mean of the nearest two.
std::array<float, kAngles> slice_radii(std::span<const Vec2f> points, const Vec2f& axis) {
    std::array<float, kAngles> radii{};
    for (const Vec2f& p : points) {
        const Vec2f d = p - axis;
        const auto bin = static_cast<std::size_t>(std::lround(angle_bin(d.x(), d.y()))) % kAngles;
        radii[bin] = std::max(radii[bin], d.norm());
    }
    const auto raw = radii;
    for (std::size_t a = 0; a < kAngles; ++a) {
        if (raw[a] > 0.0f) continue;
        float sum = 0.0f;
        for (const std::size_t way : {std::size_t{1}, kAngles - 1}) {
            std::size_t k = (a + way) % kAngles;
            while (raw[k] == 0.0f && k != a)
                k = (k + way) % kAngles;
            sum += 0.5f * raw[k];
        }
        radii[a] = sum;
    }
    return radii;
}

TrunkProfile measure_trunk(const Skeleton& skeleton, std::span<const Vec3f> positions,
                           std::span<const Part> parts) {
    TrunkProfile trunk;
    trunk.bottom = skeleton.rest(Joint::left_upper_leg).y() - 0.06f;
    const float top = skeleton.rest(Joint::left_upper_arm).y();
    trunk.step = (top - trunk.bottom) / static_cast<float>(kSlices - 1);
    // Up here the surface runs on into the arms: the trunk ends at the shoulder joints.
    const float widest = std::abs(skeleton.rest(Joint::left_upper_arm).x());
    std::vector<Vec2f> points;
    for (std::size_t s = 0; s < kSlices; ++s) {
        const float height = trunk.bottom + trunk.step * static_cast<float>(s);
        points.clear();
        for (float reach = 0.6f * trunk.step; points.size() < 12; reach *= 1.5f) {
            if (reach > 0.5f)
                throw Error("body surface: no trunk near height " + std::to_string(height) + " m");
            points.clear();
            for (std::size_t v = 0; v < positions.size(); ++v) {
                const Vec3f& p = positions[v];
                if (!is_trunk(parts[v]) || std::abs(p.y() - height) > reach) continue;
                if (std::abs(p.x()) > widest) continue;
                points.emplace_back(p.x(), p.z());
            }
        }
        trunk.axis[s] = slice_axis(points);
        trunk.radius[s] = slice_radii(points, trunk.axis[s]);
    }
    return trunk;
}

/// Mean distance of the part's vertices from the bone near both ends of [from, to] (fractions).
LimbProfile measure_limb(const Vec3f& a, const Vec3f& b, float from, float to, Part part,
                         std::span<const Vec3f> positions, std::span<const Part> parts) {
    const Vec3f bone = b - a;
    std::array<float, 2> sum{};
    std::array<float, 2> count{};
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (parts[v] != part) continue;
        const float t = (positions[v] - a).dot(bone) / bone.squaredNorm();
        if (t < from || t > to) continue;
        const std::size_t end = t < 0.5f * (from + to) ? 0 : 1;
        sum[end] += (positions[v] - (a + t * bone)).norm();
        count[end] += 1.0f;
    }
    if (count[0] == 0.0f || count[1] == 0.0f) {
        throw Error("body surface: part " + std::to_string(static_cast<int>(part)) +
                    " has no vertices along its bone");
    }
    return {sum[0] / count[0], sum[1] / count[1]};
}

Vec3f find_fingertip(const Skeleton& skeleton, std::size_t side, std::span<const Vec3f> positions,
                     std::span<const Part> parts) {
    const Joint hand = side == 0 ? Joint::left_hand : Joint::right_hand;
    const Part part = side == 0 ? Part::left_lower_arm : Part::right_lower_arm;
    const Vec3f wrist = skeleton.rest(hand);
    const Vec3f along = skeleton.offset(hand).normalized();
    Vec3f tip = wrist + 0.17f * along;
    float farthest = 0.0f;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const float reach = (positions[v] - wrist).dot(along);
        if (parts[v] != part || reach <= farthest) continue;
        farthest = reach;
        tip = positions[v];
    }
    return tip;
}

void keep_deepest(BodyVolumes::Depth& best, float depth, const Vec3f& out) noexcept {
    if (depth > best.depth) best = {depth, out};
}

} // namespace

float TrunkProfile::at(float height, float angle) const noexcept {
    const float y = (height - bottom) / step;
    // Rounded ends: the profile shrinks to nothing within one slice.
    const float end = std::min({1.0f, y + 1.0f, static_cast<float>(kSlices) - y});
    if (end <= 0.0f) return 0.0f;
    const float clamped = std::clamp(y, 0.0f, static_cast<float>(kSlices - 1));
    const auto s = std::min(static_cast<std::size_t>(clamped), kSlices - 2);
    const float ty = clamped - static_cast<float>(s);
    const auto a = static_cast<std::size_t>(angle) % kAngles;
    const float ta = angle - std::floor(angle);
    const std::size_t b = (a + 1) % kAngles;
    const float low = radius[s][a] + ta * (radius[s][b] - radius[s][a]);
    const float high = radius[s + 1][a] + ta * (radius[s + 1][b] - radius[s + 1][a]);
    return end * (low + ty * (high - low));
}

Vec2f TrunkProfile::axis_at(float height) const noexcept {
    const float y = std::clamp((height - bottom) / step, 0.0f, static_cast<float>(kSlices - 1));
    const auto s = std::min(static_cast<std::size_t>(y), kSlices - 2);
    const float t = y - static_cast<float>(s);
    return axis[s] + t * (axis[s + 1] - axis[s]);
}

BodyVolumes::Depth BodyVolumes::depth(const Vec3f& point, float radius, const Skeleton& skeleton,
                                      const JointTransforms& world) const noexcept {
    Depth best;
    const auto to_rest = [&](Joint joint) -> Vec3f {
        const RigidTransform& t = world[index(joint)];
        return t.rotation.conjugate() * (point - t.translation) + skeleton.rest(joint);
    };
    // Trunk: each trunk joint sees the point in its own rest coordinates; blended by height.
    constexpr std::array joints = {Joint::hips, Joint::spine, Joint::chest, Joint::upper_chest};
    const float height = to_rest(Joint::chest).y();
    float sum = 0.0f;
    Vec3f out = Vec3f::Zero();
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const float here = skeleton.rest(joints[j]).y();
        float weight = 1.0f;
        if (j + 1 < joints.size()) {
            const float next = skeleton.rest(joints[j + 1]).y();
            weight *= 1.0f - std::clamp((height - here) / (next - here), 0.0f, 1.0f);
        }
        if (j > 0) {
            const float last = skeleton.rest(joints[j - 1]).y();
            weight *= std::clamp((height - last) / (here - last), 0.0f, 1.0f);
        }
        if (weight <= 0.0f) continue;
        const Vec3f p = to_rest(joints[j]);
        const Vec2f axis = trunk.axis_at(p.y());
        const Vec2f d(p.x() - axis.x(), p.z() - axis.y());
        const float distance = d.norm();
        const float surface = trunk.at(p.y(), angle_bin(d.x(), d.y()));
        if (surface <= 0.0f) continue;
        const Vec3f way = unit_or(Vec3f(d.x(), 0.0f, d.y()), Vec3f::UnitZ());
        sum += weight * (surface + radius - distance);
        out += weight * (world[index(joints[j])].rotation * way);
    }
    if (sum != 0.0f) keep_deepest(best, sum, unit_or(out, Vec3f::UnitZ()));
    // Head: an ellipsoid.
    const Vec3f h = to_rest(Joint::head) - head_centre;
    const Vec3f grown = head_radii + Vec3f::Constant(radius);
    const float ratio = h.cwiseQuotient(grown).norm();
    const Vec3f normal = unit_or(h.cwiseQuotient(grown.cwiseProduct(grown)), Vec3f::UnitZ());
    keep_deepest(best, (1.0f - ratio) * grown.minCoeff(),
                 world[index(Joint::head)].rotation * normal);
    // Thighs: tapered capsules.
    for (std::size_t side = 0; side < 2; ++side) {
        const Joint hip = side == 0 ? Joint::left_upper_leg : Joint::right_upper_leg;
        const Vec3f& a = world[index(hip)].translation;
        const Vec3f bone = world[index(hip) + 1].translation - a;
        const float t = std::clamp((point - a).dot(bone) / bone.squaredNorm(), 0.0f, 1.0f);
        const Vec3f d = point - (a + t * bone);
        const float thick =
            thigh[side].start_radius + t * (thigh[side].end_radius - thigh[side].start_radius);
        keep_deepest(best, thick + radius - d.norm(), unit_or(d, Vec3f::UnitZ()));
    }
    return best;
}

BodyVolumes measure_volumes(const Skeleton& skeleton, std::span<const Vec3f> positions,
                            std::span<const Part> parts) {
    if (positions.size() != parts.size()) throw Error("body surface: one part label a vertex");
    BodyVolumes volumes;
    volumes.trunk = measure_trunk(skeleton, positions, parts);
    Eigen::AlignedBox3f head;
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (parts[v] == Part::head) head.extend(positions[v]);
    if (head.isEmpty()) throw Error("body surface: no vertex is labelled head");
    volumes.head_centre = head.center();
    volumes.head_radii = 0.5f * head.sizes();
    for (std::size_t side = 0; side < 2; ++side) {
        const bool left = side == 0;
        const auto limb = [&](Joint joint, float from, float to, Part part) {
            return measure_limb(skeleton.rest(joint), skeleton.rest_positions[index(joint) + 1],
                                from, to, part, positions, parts);
        };
        volumes.upper_arm[side] = limb(left ? Joint::left_upper_arm : Joint::right_upper_arm, 0.4f,
                                       1.0f, left ? Part::left_upper_arm : Part::right_upper_arm);
        volumes.lower_arm[side] = limb(left ? Joint::left_lower_arm : Joint::right_lower_arm, 0.0f,
                                       1.0f, left ? Part::left_lower_arm : Part::right_lower_arm);
        volumes.thigh[side] = limb(left ? Joint::left_upper_leg : Joint::right_upper_leg, 0.2f,
                                   1.0f, left ? Part::left_upper_leg : Part::right_upper_leg);
        volumes.fingertip[side] = find_fingertip(skeleton, side, positions, parts);
    }
    return volumes;
}

} // namespace toile::body
