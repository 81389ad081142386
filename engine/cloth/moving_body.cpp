#include "cloth/moving_body.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::cloth {
namespace {

Vec4 to_vec4(const Vec3f& p) {
    return {p.x(), p.y(), p.z(), 0.0f};
}

void check(const BodyRest& rest) {
    const std::size_t count = rest.positions.size();
    if (count == 0 || rest.triangles.empty()) {
        throw Error("body: has no vertices or no triangles");
    }
    if (rest.joints.size() != count || rest.weights.size() != count) {
        throw Error("body: " + std::to_string(rest.joints.size()) + " joint rows and " +
                    std::to_string(rest.weights.size()) + " weight rows for " +
                    std::to_string(count) + " vertices");
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (!rest.positions[v].allFinite()) {
            throw Error("body: vertex " + std::to_string(v) + " is not finite");
        }
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(std::abs(rest.weights[v][k]) <= 1.5f) || rest.joints[v][k] >= kBodyJoints) {
                throw Error("body: vertex " + std::to_string(v) + " has a bad joint weight");
            }
        }
    }
    for (std::size_t t = 0; t < rest.triangles.size(); ++t) {
        const Triangle& corner = rest.triangles[t];
        if (*std::max_element(corner.begin(), corner.end()) >= count) {
            throw Error("body: triangle " + std::to_string(t) + " names a vertex out of range");
        }
    }
}

/// The joint that moves each triangle most. (nf) \throw Error when the body is unfit
std::vector<std::uint8_t> triangle_joints(const BodyRest& rest) {
    check(rest);
    std::vector<std::uint8_t> joints(rest.triangles.size());
    for (std::size_t t = 0; t < joints.size(); ++t) {
        std::array<float, kBodyJoints> sum{};
        for (const std::uint32_t v : rest.triangles[t]) {
            for (std::size_t k = 0; k < 4; ++k) {
                sum[rest.joints[v][k]] += rest.weights[v][k];
            }
        }
        joints[t] =
            static_cast<std::uint8_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
    }
    return joints;
}

} // namespace

MovingBody::MovingBody(const BodyRest& rest)
    : surface_(rest.triangles, rest.positions.size(), triangle_joints(rest)) {
    const std::size_t count = rest.positions.size();
    std::vector<std::uint8_t> vertex_joint(count, 0);
    for (std::size_t v = 0; v < count; ++v) {
        const auto& w = rest.weights[v];
        const auto k = static_cast<std::size_t>(std::max_element(w.begin(), w.end()) - w.begin());
        vertex_joint[v] = static_cast<std::uint8_t>(rest.joints[v][k]);
    }
    choose_seeds(rest.positions, vertex_joint);

    for (std::vector<Vec4>* buffer : {&before_, &after_, &now_}) {
        buffer->resize(count);
        std::transform(rest.positions.begin(), rest.positions.end(), buffer->begin(), to_vec4);
    }
    for (std::vector<Vec4>* buffer : {&normal_before_, &normal_after_, &normal_}) {
        buffer->resize(count);
        compute_normals(now_, *buffer);
    }
    place(1.0f);
}

/// Farthest-point seeds on the part of each joint.
void MovingBody::choose_seeds(std::span<const Vec3f> rest,
                              std::span<const std::uint8_t> vertex_joint) {
    constexpr std::size_t kSeeds = 48;
    for (std::size_t joint = 0; joint < kBodyJoints; ++joint) {
        Part& part = parts_[joint];
        std::vector<std::uint32_t> members;
        for (std::uint32_t v = 0; v < rest.size(); ++v) {
            if (vertex_joint[v] == joint && !surface_.star(v).empty()) {
                members.push_back(v);
            }
        }
        std::vector<float> apart(members.size(), std::numeric_limits<float>::infinity());
        std::size_t chosen = 0;
        while (!members.empty() && part.vertices.size() < std::min(kSeeds, members.size())) {
            part.vertices.push_back(members[chosen]);
            part.triangles.push_back(surface_.star(members[chosen]).front());
            for (std::size_t i = 0; i < members.size(); ++i) {
                apart[i] = std::min(apart[i], (rest[members[i]] - rest[members[chosen]]).norm());
            }
            chosen = static_cast<std::size_t>(std::max_element(apart.begin(), apart.end()) -
                                              apart.begin());
        }
        part.spacing = members.empty() ? 0.0f : apart[chosen];
        // A whole number of eight lanes; the filling never wins.
        const std::size_t lanes = (part.vertices.size() + 7) / 8 * 8;
        for (std::vector<float>* axis : {&part.x, &part.y, &part.z}) {
            axis->assign(lanes, 1e6f);
        }
    }
}

void MovingBody::compute_normals(std::span<const Vec4> positions,
                                 std::span<Vec4> normals) const noexcept {
    std::fill(normals.begin(), normals.end(), Vec4::Zero());
    for (const Triangle& corner : triangles()) {
        const Vec4 a = positions[corner[0]];
        const Vec4 area = (positions[corner[1]] - a).cross3(positions[corner[2]] - a);
        for (const std::uint32_t v : corner) {
            normals[v] += area;
        }
    }
    for (Vec4& normal : normals) {
        const float length = normal.norm();
        if (length > 0.0f) {
            normal /= length;
        }
    }
}

void MovingBody::set_motion(std::span<const Vec3f> before, std::span<const Vec3f> after,
                            float dt) noexcept {
    const auto same = [&] {
        for (std::size_t v = 0; v < before.size(); ++v) {
            if (to_vec4(before[v]) != after_[v]) {
                return false;
            }
        }
        return true;
    };
    // Frame after frame the start is the last end, whose normals are known.
    if (same()) {
        before_.swap(after_);
        normal_before_.swap(normal_after_);
    } else {
        std::transform(before.begin(), before.end(), before_.begin(), to_vec4);
        compute_normals(before_, normal_before_);
    }
    std::transform(after.begin(), after.end(), after_.begin(), to_vec4);
    if (std::equal(after_.begin(), after_.end(), before_.begin())) {
        std::copy(normal_before_.begin(), normal_before_.end(), normal_after_.begin());
    } else {
        compute_normals(after_, normal_after_);
    }
    per_second_ = dt > 0.0f ? 1.0f / dt : 0.0f;
    for (Part& part : parts_) {
        float farthest = 0.0f;
        for (const std::uint32_t v : part.vertices) {
            farthest = std::max(farthest, (after_[v] - before_[v]).squaredNorm());
        }
        part.speed = std::sqrt(farthest) * per_second_;
    }
}

void MovingBody::place(float fraction) noexcept {
    for (std::size_t v = 0; v < now_.size(); ++v) {
        now_[v] = before_[v] + fraction * (after_[v] - before_[v]);
        normal_[v] = normal_before_[v] + fraction * (normal_after_[v] - normal_before_[v]);
    }
    for (Part& part : parts_) {
        part.low.setConstant(1e6f);
        part.high.setConstant(-1e6f);
        for (std::size_t s = 0; s < part.vertices.size(); ++s) {
            const Vec4& p = now_[part.vertices[s]];
            part.x[s] = p.x();
            part.y[s] = p.y();
            part.z[s] = p.z();
            part.low = part.low.cwiseMin(p);
            part.high = part.high.cwiseMax(p);
        }
    }
}

std::uint32_t MovingBody::start_on(std::size_t joint, const Vec4& p, float reach,
                                   float period) const noexcept {
    const Part& part = parts_[joint];
    const float margin = reach + part.speed * period + part.spacing;
    if (part.vertices.empty() || ((p - part.low).head<3>().array() < -margin).any() ||
        ((p - part.high).head<3>().array() > margin).any()) {
        return kNone;
    }
    float best = std::numeric_limits<float>::infinity();
    std::size_t nearest = 0;
    for (std::size_t base = 0; base < part.x.size(); base += 8) {
        using Lanes = Eigen::Array<float, 8, 1>;
        const Lanes dx = Eigen::Map<const Lanes>(&part.x[base]) - p.x();
        const Lanes dy = Eigen::Map<const Lanes>(&part.y[base]) - p.y();
        const Lanes dz = Eigen::Map<const Lanes>(&part.z[base]) - p.z();
        const Lanes squared = dx * dx + dy * dy + dz * dz;
        if (squared.minCoeff() < best) {
            Eigen::Index lane = 0;
            best = squared.minCoeff(&lane);
            nearest = base + static_cast<std::size_t>(lane);
        }
    }
    return best < margin * margin ? part.triangles[nearest] : kNone;
}

Vec4 MovingBody::normal_at(const SurfacePoint& at) const noexcept {
    const Triangle& corner = triangles()[at.triangle];
    const Vec4 sum = at.bary[0] * normal_[corner[0]] + at.bary[1] * normal_[corner[1]] +
                     at.bary[2] * normal_[corner[2]];
    const float length = sum.norm();
    return length > 1e-12f ? Vec4(sum / length) : Vec4(Vec4::Zero());
}

Vec4 MovingBody::velocity_at(const SurfacePoint& at) const noexcept {
    const Triangle& corner = triangles()[at.triangle];
    Vec4 sum = Vec4::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        sum += at.bary[k] * (after_[corner[k]] - before_[corner[k]]);
    }
    return sum * per_second_;
}

} // namespace toile::cloth
