#include "geometry/surface_probe.h"

#include <cstring>
#include <embree3/rtcore.h>

namespace toile::geometry {
namespace {

/// Barycentric coordinates of the point of triangle abc nearest to p (Ericson 2005, 5.1.5).
Vec3f nearest_barycentric(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const float d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0.0f && d2 <= 0.0f) return {1.0f, 0.0f, 0.0f};
    const float d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0.0f && d4 <= d3) return {0.0f, 1.0f, 0.0f};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
        const float t = d1 / (d1 - d3);
        return {1.0f - t, t, 0.0f};
    }
    const float d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0.0f && d5 <= d6) return {0.0f, 0.0f, 1.0f};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
        const float t = d2 / (d2 - d6);
        return {1.0f - t, 0.0f, t};
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
        const float t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0.0f, 1.0f - t, t};
    }
    const float scale = 1.0f / (va + vb + vc);
    return {va * scale, vb * scale, vc * scale};
}

} // namespace

struct SurfaceProbe::State {
    std::span<const Vec3f> positions;
    std::span<const Triangle> triangles;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    struct Query {
        const State* state;
        Vec3f point;
        ProbeHit hit;
    };

    static bool visit(RTCPointQueryFunctionArguments* arguments) {
        auto& query = *static_cast<Query*>(arguments->userPtr);
        const State& state = *query.state;
        const Triangle& t = state.triangles[arguments->primID];
        const Vec3f &a = state.positions[t[0]], &b = state.positions[t[1]],
                    &c = state.positions[t[2]];
        const Vec3f w = nearest_barycentric(query.point, a, b, c);
        const Vec3f q = w.x() * a + w.y() * b + w.z() * c;
        const float d = (q - query.point).norm();
        if (d > arguments->query->radius || d > query.hit.distance ||
            (d == query.hit.distance && arguments->primID > query.hit.triangle))
            return false;
        query.hit = {arguments->primID, q, w, d};
        arguments->query->radius = d;
        return true;
    }
};

SurfaceProbe::SurfaceProbe(std::span<const Vec3f> positions, std::span<const Triangle> triangles)
    : state_(std::make_unique<State>(State{positions, triangles, nullptr, nullptr})) {
    state_->device = rtcNewDevice("threads=1");
    state_->scene = rtcNewScene(state_->device);
    RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vec3f), positions.size());
    std::memcpy(vertices, positions.data(), positions.size_bytes());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(Triangle), triangles.size());
    std::memcpy(indices, triangles.data(), triangles.size_bytes());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(state_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(state_->scene);
}

SurfaceProbe::~SurfaceProbe() {
    rtcReleaseScene(state_->scene);
    rtcReleaseDevice(state_->device);
}

ProbeHit SurfaceProbe::nearest(const Vec3f& p, float limit) const {
    State::Query query{state_.get(), p, {}};
    RTCPointQuery point{};
    point.x = p.x();
    point.y = p.y();
    point.z = p.z();
    point.radius = limit;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(state_->scene, &point, &context, &State::visit, &query);
    return query.hit;
}

} // namespace toile::geometry
