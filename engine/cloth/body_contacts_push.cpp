// The push of body_contacts.h: what happens in every substep.
#include "cloth/body_contacts.h"

#include <algorithm>
#include <cmath>

namespace toile::cloth {
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

/// push_vertex for eight at a time, with the same sums in the same order.
void BodyContacts::push_block(const Particles& particles, const PlaneBlock& block, float since,
                              float substep, const ContactSettings& settings) noexcept {
    const auto dot3 = [](const Lanes3& a, const Lanes3& b) { // as Eigen adds four
        return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(a.x, b.x), _mm256_mul_ps(a.z, b.z)),
                             _mm256_mul_ps(a.y, b.y));
    };
    const auto times = [](__m256 s, const Lanes3& a) {
        return Lanes3{_mm256_mul_ps(s, a.x), _mm256_mul_ps(s, a.y), _mm256_mul_ps(s, a.z)};
    };
    const __m256 zero = _mm256_setzero_ps();
    const Lanes3 normal{load(block.normal[0]), load(block.normal[1]), load(block.normal[2])};
    Lanes3 x = load_rows(particles.x.data(), block.vertex);
    const __m256 moving = _mm256_mul_ps(load(block.velocity[3]), _mm256_set1_ps(since));
    const __m256 height =
        _mm256_sub_ps(_mm256_sub_ps(dot3(normal, x), load(block.normal[3])), moving);
    __m256 push = _mm256_sub_ps(_mm256_set1_ps(settings.offset), height);
    __m256 pushed = _mm256_cmp_ps(push, zero, _CMP_GT_OQ);
    if (_mm256_movemask_ps(pushed) == 0) {
        return;
    }
    const __m256 weight = _mm256_i32gather_ps(
        particles.w.data(), _mm256_load_si256(reinterpret_cast<const __m256i*>(block.vertex)), 4);
    pushed = _mm256_and_ps(pushed, _mm256_cmp_ps(weight, zero, _CMP_GT_OQ));
    push = _mm256_and_ps(push, pushed);
    x = x + times(push, normal);
    Lanes3 q = load_rows(particles.q.data(), block.vertex);
    const Lanes3 velocity{load(block.velocity[0]), load(block.velocity[1]),
                          load(block.velocity[2])};
    const Lanes3 moved = x - q - times(_mm256_set1_ps(substep), velocity);
    const __m256 along = dot3(moved, normal);
    const Lanes3 slide = moved - times(along, normal);
    const __m256 length = _mm256_sqrt_ps(dot3(slide, slide));
    const __m256 limit = _mm256_mul_ps(_mm256_set1_ps(settings.friction), push);
    const __m256 sticks = _mm256_cmp_ps(
        length, _mm256_mul_ps(_mm256_set1_ps(settings.static_share), limit), _CMP_LE_OQ);
    const __m256 share =
        _mm256_blendv_ps(_mm256_div_ps(limit, length), _mm256_set1_ps(1.0f), sticks);
    x = x - times(_mm256_and_ps(share, pushed), slide);
    q = q + times(_mm256_and_ps(_mm256_max_ps(along, zero), pushed), normal);
    store_rows(particles.x.data(), block.vertex, x);
    store_rows(particles.q.data(), block.vertex, q);
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
                           const ContactSettings& settings, bool centres) const noexcept {
    for (const std::vector<ActivePlane>* list : {&other_centres_, &own_centres_}) {
        for (std::size_t i = 0; centres && i < list->size(); ++i) {
            const ActivePlane& active = (*list)[i];
            push_centre(particles, triangles_[active.sample - vertex_count_], active.plane, since,
                        substep, settings);
        }
    }
    for (const ActivePlane& active : other_vertices_) {
        push_vertex(particles, active.sample, active.plane, since, substep, settings);
    }
    for (const PlaneBlock& block : own_vertices_) {
        push_block(particles, block, since, substep, settings);
    }
}

} // namespace toile::cloth
