#include "cloth/body_contacts.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::cloth {
namespace {

constexpr float kNearSkin = 0.025f; ///< m, where the place on the body is kept up to date
constexpr float kTouching = 0.03f;  ///< m, where a plane may push before the next refresh

/// No plane yet, or beside the end of what the sample covers.
bool is_nowhere(const Vec4& normal) {
    return normal.w() < -1e5f;
}

/// Could a sample at p, moving at v, come within `distance` of the plane in `time` seconds?
inline bool is_near(const Vec4& normal, const Vec4& velocity, const Vec4& p, const Vec4& v,
                    float distance, float time) {
    const float height = normal.dot(p) - normal.w();
    const float closing = velocity.w() - normal.dot(v);
    return height - std::max(0.0f, closing) * time < distance;
}

} // namespace

const BodyContacts::Plane BodyContacts::kNowhere{Vec4(0.0f, 0.0f, 0.0f, -1e6f), Vec4::Zero()};

BodyContacts::BodyContacts(std::span<const Triangle> triangles, std::size_t vertex_count,
                           std::span<const std::array<std::uint16_t, 4>> joints,
                           std::span<const std::array<float, 4>> weights, bool centres)
    : triangles_(triangles.begin(), triangles.end()), vertex_count_(vertex_count) {
    check_skin(joints, weights, vertex_count);
    const std::size_t samples = vertex_count + (centres ? triangles_.size() : 0);
    mask_.resize(samples);
    for (std::size_t v = 0; v < vertex_count; ++v) {
        mask_[v] = covered_parts(joints[v], weights[v]);
    }
    for (std::size_t t = 0; t < samples - vertex_count; ++t) {
        for (const std::uint32_t v : triangles_[t]) {
            mask_[vertex_count + t] |= mask_[v];
        }
    }
    anchor_.assign(samples, kNone);
    own_triangle_.assign(samples, kNone);
    other_triangle_.assign(samples, kNone);
    own_plane_.assign(samples, kNowhere);
    other_plane_.assign(samples, kNowhere);
    own_place_.assign(samples, {1.0f, 0.0f, 0.0f});
    drift_.assign(samples, 0.0f);
    squeezed_.assign(samples, 0);
    own_vertices_.reserve(vertex_count / kLanes + 1);
    for (std::vector<ActivePlane>* list : {&other_vertices_, &own_centres_, &other_centres_}) {
        list->reserve(samples);
    }
}

void BodyContacts::bind(const MovingBody& rest_body, std::span<const Vec3f> start) {
    constexpr float kAnywhere = 1e4f; // m
    for (std::size_t s = 0; s < anchor_.size(); ++s) {
        Vec3f at = Vec3f::Zero();
        if (s < vertex_count_) {
            at = start[s];
        } else {
            const Triangle& corner = triangles_[s - vertex_count_];
            at = (start[corner[0]] + start[corner[1]] + start[corner[2]]) / 3.0f;
        }
        const Vec4 p(at.x(), at.y(), at.z(), 0.0f);
        SurfacePoint nearest;
        for (std::size_t joint = 0; joint < kBodyJoints; ++joint) {
            const std::uint32_t from = ((mask_[s] >> joint) & 1u) != 0
                                           ? rest_body.start_on(joint, p, kAnywhere, 0.0f)
                                           : kNone;
            if (from != kNone) {
                const SurfacePoint found = rest_body.walk(p, from, mask_[s]);
                nearest = found.squared < nearest.squared ? found : nearest;
            }
        }
        if (nearest.triangle == kNone) {
            throw Error("garment: the body has no surface at the joints of sample " +
                        std::to_string(s));
        }
        anchor_[s] = nearest.triangle;
    }
    reset();
}

void BodyContacts::reset() noexcept {
    std::copy(anchor_.begin(), anchor_.end(), own_triangle_.begin());
    std::fill(other_triangle_.begin(), other_triangle_.end(), kNone);
    std::fill(own_plane_.begin(), own_plane_.end(), kNowhere);
    std::fill(squeezed_.begin(), squeezed_.end(), std::uint8_t{0});
}

JointMask BodyContacts::mask_for(std::size_t sample, const MovingBody& body,
                                 std::uint32_t triangle) const noexcept {
    const JointMask mask = mask_[sample];
    return ((mask >> body.joint_of(triangle)) & 1u) != 0 ? mask : ~mask;
}

BodyContacts::Plane BodyContacts::plane_at(const MovingBody& body, const Vec4& p,
                                           const SurfacePoint& at) noexcept {
    constexpr float kNear = 0.004f; // m, where the direction to the surface says little
    constexpr float kSlant = 0.5f;
    Plane plane{body.normal_at(at), body.velocity_at(at)};
    const float height = (p - at.point).dot(plane.normal);
    const float distance = std::sqrt(at.squared);
    if (distance > kNear && std::abs(height) < kSlant * distance) {
        return kNowhere; // beside the end of what it covers, not over it
    }
    plane.velocity.w() = plane.normal.dot(plane.velocity);
    plane.normal.w() = plane.normal.dot(at.point);
    return plane;
}

/// Is another part, or another place of its own, nearer than where the sample has been?
void BodyContacts::look_around(const MovingBody& body, const Vec4& p, std::size_t sample,
                               const ContactSettings& settings, float period,
                               SurfacePoint& own) noexcept {
    constexpr float kApart = 0.02f;     // m, between two places worth two contacts
    constexpr float kOutside = -0.002f; // m, a new place is first met from outside
    const float own_distance = signed_distance(body, p, own);
    // Close to its own place, a walk has found the nearest of what is connected to it.
    const JointMask skipped = own_distance < kNearSkin
                                  ? mask_[sample] & connected_parts(body.joint_of(own.triangle))
                                  : 0u;
    SurfacePoint other;
    for (std::size_t joint = 0; joint < kBodyJoints; ++joint) {
        if (((skipped >> joint) & 1u) != 0) {
            continue;
        }
        const std::uint32_t start = body.start_on(joint, p, settings.reach, period);
        if (start == kNone) {
            continue;
        }
        const SurfacePoint found = body.walk(p, start, mask_for(sample, body, start));
        if (found.triangle == kNone || found.triangle == own.triangle) {
            continue;
        }
        const bool covers = ((mask_[sample] >> body.joint_of(found.triangle)) & 1u) != 0;
        if (covers && own_distance > 0.0f && found.squared < 0.9f * own.squared) {
            own = found;
        } else if (found.squared < other.squared &&
                   (found.point - own.point).squaredNorm() > kApart * kApart &&
                   (covers
                        ? signed_distance(body, p, found) > kOutside || faces(body, own, found)
                        : signed_distance(body, p, found) > kOutside && !lifts(body, own, found))) {
            other = found;
        }
    }
    if (other_triangle_[sample] == kNone) {
        other_triangle_[sample] = other.triangle;
    } else if (other.triangle != kNone) {
        const SurfacePoint kept =
            body.walk(p, other_triangle_[sample], mask_for(sample, body, other_triangle_[sample]));
        if (other.squared < kept.squared && signed_distance(body, p, kept) > 0.0f) {
            other_triangle_[sample] = other.triangle;
        }
    }
}

void BodyContacts::place_sample(const MovingBody& body, const Vec4& p, std::size_t sample,
                                const SurfacePoint& nearest, const ContactSettings& settings,
                                float period) noexcept {
    SurfacePoint own = nearest;
    SurfacePoint other;
    if (other_triangle_[sample] != kNone) {
        other =
            body.walk(p, other_triangle_[sample], mask_for(sample, body, other_triangle_[sample]));
        // A sleeve stays with its own arm where that runs into another part.
        const std::uint8_t home = body.joint_of(anchor_[sample]);
        if (other.triangle != kNone && same_part(body.joint_of(other.triangle), home) &&
            !same_part(body.joint_of(own.triangle), home) &&
            signed_distance(body, p, other) < 0.0f) {
            std::swap(own, other);
        }
    }
    own_triangle_[sample] = own.triangle;
    own_place_[sample] = {own.bary[0], own.bary[1], own.bary[2]};
    own_plane_[sample] = plane_at(body, p, own);
    drift_[sample] = 0.0f;
    squeezed_[sample] = 0;
    if (other.triangle == kNone) {
        other_triangle_[sample] = kNone;
        return;
    }
    const bool covers = ((mask_[sample] >> body.joint_of(other.triangle)) & 1u) != 0;
    const float height = signed_distance(body, p, other);
    const float forget = 2.0f * settings.reach + body.velocity_at(other).norm() * period;
    const bool gone = other.squared > forget * forget;
    const bool far_side = covers && height < -kThinnest;
    if (gone || far_side || other.triangle == own.triangle ||
        (!covers && lifts(body, own, other))) {
        other_triangle_[sample] = kNone;
        return;
    }
    other_triangle_[sample] = other.triangle;
    other_plane_[sample] = on_rim(body, other, mask_for(sample, body, other.triangle)) &&
                                   height < kOverRim * std::sqrt(other.squared)
                               ? kNowhere
                               : plane_at(body, p, other);
    if (own.squared < settings.reach * settings.reach) {
        squeezed_[sample] =
            share_room(own_plane_[sample], other_plane_[sample], own.point,
                       sample < vertex_count_ ? settings.offset : settings.centre_offset);
    }
}

/// Has the sample slid so far over the skin that its plane says too little? A plane moves with the
/// skin; 3 mm beside its point, skin bent with a radius of 3 cm is 0.15 mm off it.
bool BodyContacts::has_drifted(const MovingBody& body, const Vec4& p, const Vec4& v,
                               std::size_t sample, const Refresh& when) noexcept {
    constexpr float kFar = 0.003f;   // m
    constexpr float kTurning = 0.2f; // share of its speed that a part may turn a plane by
    constexpr float kAloft = 0.25f;  // share of its height that a lazy sample may slide
    const Plane& plane = own_plane_[sample];
    const float sliding = direction(v - plane.velocity).norm();
    const float turning = kTurning * body.speed_of(body.joint_of(own_triangle_[sample]));
    drift_[sample] += (sliding + turning) * when.since_last;
    const float aloft =
        when.lazy_frame != 0 ? kAloft * (plane.normal.dot(p) - plane.normal.w()) : 0;
    return drift_[sample] > std::max(kFar, aloft);
}

void BodyContacts::carry(const MovingBody& body, const Vec4& p, std::size_t sample) noexcept {
    SurfacePoint at;
    at.triangle = own_triangle_[sample];
    const Triangle& corner = body.triangles()[at.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
        at.bary[k] = own_place_[sample][k];
        at.point += at.bary[k] * body.positions()[corner[k]];
    }
    at.squared = (p - at.point).squaredNorm();
    own_plane_[sample] = plane_at(body, p, at);
}

void BodyContacts::refresh_vertex(const MovingBody& body, const Vec4& p, const Vec4& v,
                                  std::uint32_t vertex, const Refresh& when,
                                  const ContactSettings& settings) noexcept {
    constexpr std::uint32_t kLook = 2; // turns of a lazy sample
    const bool turn = !when.last && vertex % when.phases == when.phase;
    Plane& plane = own_plane_[vertex];
    plane.normal.w() += plane.velocity.w() * when.since_last;
    const bool unknown = other_triangle_[vertex] != kNone || is_nowhere(plane.normal);
    const bool drifted = has_drifted(body, p, v, vertex, when);
    const bool near =
        unknown || (drifted && is_near(plane.normal, plane.velocity, p, v, kNearSkin, when.period));
    const bool looks = turn && (when.lazy_frame == 0 || (vertex + when.lazy_frame) % kLook == 0);
    if (!near && !looks && !(turn && drifted)) {
        if (turn) {
            carry(body, p, vertex);
        }
        return;
    }
    SurfacePoint own = body.walk(p, own_triangle_[vertex], mask_[vertex]);
    if (own.triangle == kNone) {
        return; // not a finite position; the world starts the garment anew
    }
    const float period = when.lazy_frame == 0 ? when.period : kLook * when.period;
    if (looks) {
        look_around(body, p, vertex, settings, period, own);
    }
    place_sample(body, p, vertex, own, settings, period); // known until it looks again
}

void BodyContacts::refresh_centre(const MovingBody& body, const Vec4& p, const Vec4& v,
                                  std::size_t triangle, const Refresh& when,
                                  const ContactSettings& settings) noexcept {
    const std::size_t sample = vertex_count_ + triangle;
    Plane& plane = own_plane_[sample];
    plane.normal.w() += plane.velocity.w() * when.since_last;
    other_plane_[sample].normal.w() += other_plane_[sample].velocity.w() * when.since_last;
    const bool turn = !when.last && triangle % when.phases == when.phase;
    const std::uint32_t told = triangles_[triangle][(triangle + when.phase) % 3];
    const bool unknown = other_triangle_[sample] != kNone || is_nowhere(plane.normal);
    const bool drifted = has_drifted(body, p, v, sample, when);
    const bool near =
        when.last &&
        (unknown || (drifted && is_near(plane.normal, plane.velocity, p, v, kNearSkin, 0.0f)));
    if (turn && when.lazy_frame != 0 && !drifted && !unknown && other_triangle_[told] == kNone) {
        carry(body, p, sample);
        return;
    }
    if (!turn && !near) {
        return;
    }
    SurfacePoint own = body.walk(p, own_triangle_[sample], mask_[sample]);
    // What a corner found, the centre learns from it.
    const std::uint32_t heard = own_triangle_[told];
    std::uint32_t second = other_triangle_[told];
    if (turn && heard != own.triangle && ((mask_[sample] >> body.joint_of(heard)) & 1u) != 0) {
        const SurfacePoint there = body.walk(p, heard, mask_[sample]);
        if (signed_distance(body, p, own) > 0.0f && there.squared < own.squared) {
            own = there;
        } else if (second == kNone && faces(body, own, there)) {
            second = heard;
        }
    }
    if (own.triangle == kNone) {
        return;
    }
    if (other_triangle_[sample] == kNone) {
        other_triangle_[sample] = second;
    }
    place_sample(body, p, sample, own, settings, when.period);
}

/// Fills the lanes of a block one by one; those to come repeat it.
void BodyContacts::list_own(std::uint32_t vertex, const Plane& plane) noexcept {
    const std::size_t lane = own_count_++ % kLanes;
    if (lane == 0) {
        own_vertices_.emplace_back();
    }
    PlaneBlock& block = own_vertices_.back();
    for (std::size_t l = lane; l < kLanes; ++l) {
        block.vertex[l] = vertex;
        for (int k = 0; k < 4; ++k) {
            block.normal[k][l] = plane.normal[k];
            block.velocity[k][l] = plane.velocity[k];
        }
    }
}

void BodyContacts::list_vertex(const Vec4& p, const Vec4& v, std::uint32_t vertex,
                               float until_next) noexcept {
    const Plane& plane = own_plane_[vertex];
    if (is_near(plane.normal, plane.velocity, p, v, kTouching, until_next)) {
        list_own(vertex, plane);
    }
    if (other_triangle_[vertex] != kNone) {
        other_vertices_.push_back({vertex, other_plane_[vertex]});
    }
}

void BodyContacts::list_centre(const Vec4& p, const Vec4& v, std::size_t sample,
                               float until_next) noexcept {
    const Plane& plane = own_plane_[sample];
    if (is_near(plane.normal, plane.velocity, p, v, kTouching, until_next)) {
        own_centres_.push_back({static_cast<std::uint32_t>(sample), plane});
    }
    if (other_triangle_[sample] != kNone) {
        other_centres_.push_back({static_cast<std::uint32_t>(sample), other_plane_[sample]});
    }
}

/// Where a sample will be: it goes on as it went, and near the skin as much faster as that.
Vec4 BodyContacts::ahead(const MovingBody& body, const Vec4& p, const Vec4& v, std::size_t sample,
                         float seconds) const noexcept {
    const Plane& plane = own_plane_[sample];
    if (seconds == 0.0f || is_nowhere(plane.normal)) {
        return p + seconds * v;
    }
    SurfacePoint at;
    at.triangle = own_triangle_[sample];
    std::copy(own_place_[sample].begin(), own_place_[sample].end(), at.bary);
    const float height = plane.normal.dot(p) - plane.normal.w();
    const float carried = std::clamp(2.0f - height / kNearSkin, 0.0f, 1.0f);
    return p + seconds * (v + carried * direction(body.velocity_at(at) - plane.velocity));
}

void BodyContacts::refresh(const MovingBody& body, std::span<const Vec4> x, std::span<const Vec4> v,
                           const Refresh& when, const ContactSettings& settings) noexcept {
    own_vertices_.clear();
    own_count_ = 0;
    other_vertices_.clear();
    own_centres_.clear();
    other_centres_.clear();
    for (std::uint32_t i = 0; i < vertex_count_; ++i) {
        const Vec4 p = ahead(body, x[i], v[i], i, when.ahead);
        refresh_vertex(body, p, v[i], i, when, settings);
        list_vertex(p, v[i], i, when.until_next);
    }
    for (std::size_t t = 0; t < sample_count() - vertex_count_; ++t) {
        const Triangle& corner = triangles_[t];
        const Vec4 speed = (v[corner[0]] + v[corner[1]] + v[corner[2]]) / 3.0f;
        const Vec4 centre = (x[corner[0]] + x[corner[1]] + x[corner[2]]) / 3.0f;
        const Vec4 p = ahead(body, centre, speed, vertex_count_ + t, when.ahead);
        refresh_centre(body, p, speed, t, when, settings);
        list_centre(p, speed, vertex_count_ + t, when.until_next);
    }
}

} // namespace toile::cloth
