// The push of body_contacts.h: what happens in every substep.
#include "cloth/body_contacts.h"

#include <algorithm>
#include <cmath>

namespace toile::cloth {
namespace {

Vec4 direction(const Vec4& normal) {
    return {normal.x(), normal.y(), normal.z(), 0.0f};
}

} // namespace

void BodyContacts::push_vertex(const Particles& particles, std::uint32_t vertex, const Plane& plane,
                               float since, float substep,
                               const ContactSettings& settings) const noexcept {
    Vec4& x = particles.x[vertex];
    const float height = plane.normal.dot(x) - plane.normal.w() - plane.velocity.w() * since;
    const float push = settings.offset - height;
    if (push <= 0.0f || particles.w[vertex] <= 0.0f) {
        return;
    }
    const Vec4 normal = direction(plane.normal);
    x += push * normal;
    // Motion against the skin in this substep: friction takes from its tangential part.
    const Vec4 moved = x - particles.q[vertex] - substep * direction(plane.velocity);
    const float along_normal = moved.dot(normal);
    const Vec4 slide = moved - along_normal * normal;
    const float length = slide.norm();
    const float limit = settings.friction * push;
    if (length <= settings.static_share * limit) {
        x -= slide;
    } else {
        x -= (limit / length) * slide;
    }
    // Being pushed out of the body is no reason to fly off.
    if (along_normal > 0.0f) {
        particles.q[vertex] += along_normal * normal;
    }
}

void BodyContacts::push_centre(const Particles& particles, const Triangle& corner,
                               const Plane& plane, float since, float substep,
                               const ContactSettings& settings) const noexcept {
    const Vec4 x = particles.x[corner[0]] + particles.x[corner[1]] + particles.x[corner[2]];
    const float height = plane.normal.dot(x) / 3.0f - plane.normal.w() - plane.velocity.w() * since;
    const float push = settings.centre_offset - height;
    const float weight = particles.w[corner[0]] + particles.w[corner[1]] + particles.w[corner[2]];
    if (push <= 0.0f || weight <= 0.0f) {
        return;
    }
    const Vec4 normal = direction(plane.normal);
    const Vec4 q = particles.q[corner[0]] + particles.q[corner[1]] + particles.q[corner[2]];
    const float moved = normal.dot(x - q) / 3.0f + push - substep * plane.velocity.w();
    for (const std::uint32_t v : corner) {
        const Vec4 shift = (3.0f * particles.w[v] / weight) * normal;
        particles.x[v] += push * shift;
        if (moved > 0.0f) {
            particles.q[v] += std::min(moved, push) * shift;
        }
    }
}

void BodyContacts::resolve(const Particles& particles, float since, float substep,
                           const ContactSettings& settings) const noexcept {
    for (const std::vector<ActivePlane>* centres : {&other_centres_, &own_centres_}) {
        for (const ActivePlane& active : *centres) {
            push_centre(particles, triangles_[active.sample - vertex_count_], active.plane, since,
                        substep, settings);
        }
    }
    for (const std::vector<ActivePlane>* vertices : {&other_vertices_, &own_vertices_}) {
        for (const ActivePlane& active : *vertices) {
            push_vertex(particles, active.sample, active.plane, since, substep, settings);
        }
    }
}

} // namespace toile::cloth
