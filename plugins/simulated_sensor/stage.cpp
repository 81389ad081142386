#include "simulated_sensor/stage.h"

#include "core/error.h"
#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <embree3/rtcore.h>

namespace toile::simulated_sensor {
namespace {

constexpr float kShadowSkin = 0.002f; // metres left out at both ends of a shadow ray
constexpr std::size_t kPacket = 8;

void check(const Surface& surface, std::span<const Vec3f> positions) {
    const auto refuse = [&](const std::string& what) {
        return Error("surface '" + surface.name + "': " + what);
    };
    if (surface.triangles.empty()) throw refuse("has no triangles");
    for (const Triangle& t : surface.triangles)
        if (*std::max_element(t.begin(), t.end()) >= positions.size())
            throw refuse("a triangle names a missing vertex");
    if (!surface.corner_coords.empty() &&
        surface.corner_coords.size() != 3 * surface.triangles.size())
        throw refuse("has not three texture coordinates a triangle");
    if (surface.rest.size() != positions.size())
        throw refuse("its rest positions are not as many as its vertices");
    if (!surface.tint.empty() && surface.tint.size() != positions.size())
        throw refuse("its tints are not as many as its vertices");
    for (const Vec3f& p : positions)
        if (!p.allFinite()) throw refuse("a position is not finite");
}

float cosine_between(float nx, float ny, float nz, const Vec3f& direction) {
    const float dot = nx * direction.x() + ny * direction.y() + nz * direction.z();
    const float lengths = (nx * nx + ny * ny + nz * nz) * direction.squaredNorm();
    return lengths > 0.0f ? std::min(1.0f, std::abs(dot) / std::sqrt(lengths)) : 0.0f;
}

RTCIntersectContext coherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

} // namespace

void HitMap::resize(int w, int h) {
    width = w;
    height = h;
    const std::size_t count = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    depth.resize(count);
    cosine.resize(count);
    surface.resize(count);
    triangle.resize(count);
    place.resize(count);
}

struct Stage::Tree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    struct Geometry {
        RTCGeometry handle = nullptr;
        float* vertices = nullptr; // Embree's own copy
    };
    std::vector<Geometry> geometries;

    Tree() {
        device = rtcNewDevice(nullptr);
        if (device == nullptr) throw Error("Embree cannot be started");
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST); // no ray slips through between triangles
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
    }
    ~Tree() {
        for (const Geometry& geometry : geometries)
            rtcReleaseGeometry(geometry.handle);
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    void add(std::span<const Triangle> triangles, std::size_t vertex_count) {
        Geometry geometry;
        geometry.handle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        geometry.vertices = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry.handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3f), vertex_count));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry.handle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(Triangle), triangles.size()));
        if (geometry.vertices == nullptr || indices == nullptr)
            throw Error("no memory for a search tree over " + std::to_string(triangles.size()) +
                        " triangles");
        for (std::size_t i = 0; i < triangles.size(); ++i)
            std::copy(triangles[i].begin(), triangles[i].end(), indices + 3 * i);
        rtcAttachGeometryByID(scene, geometry.handle, static_cast<unsigned>(geometries.size()));
        geometries.push_back(geometry);
    }
};

Stage::Stage() : tree_(std::make_unique<Tree>()) {}
Stage::~Stage() = default;

std::uint32_t Stage::add(Surface surface, std::span<const Vec3f> positions) {
    check(surface, positions);
    tree_->add(surface.triangles, positions.size());
    Moving moving;
    moving.positions.assign(positions.begin(), positions.end());
    moving.normals.resize(positions.size());
    surfaces_.push_back(std::move(surface));
    moving_.push_back(std::move(moving));
    return static_cast<std::uint32_t>(surfaces_.size() - 1);
}

void Stage::move(std::uint32_t surface, std::span<const Vec3f> positions) {
    Moving& moving = moving_.at(surface);
    if (positions.size() != moving.positions.size())
        throw Error("surface '" + surfaces_[surface].name + "': its vertices changed in number");
    std::copy(positions.begin(), positions.end(), moving.positions.begin());
    moving.fresh = true;
}

void Stage::commit() {
    for (std::size_t i = 0; i < moving_.size(); ++i) {
        Moving& moving = moving_[i];
        if (!moving.fresh) continue;
        const Tree::Geometry& geometry = tree_->geometries[i];
        for (std::size_t v = 0; v < moving.positions.size(); ++v)
            std::copy_n(moving.positions[v].data(), 3, geometry.vertices + 3 * v);
        rtcUpdateGeometryBuffer(geometry.handle, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry.handle);
        geometry::vertex_normals(moving.positions, surfaces_[i].triangles, moving.normals);
        moving.fresh = false;
    }
    rtcCommitScene(tree_->scene);
    if (rtcGetDeviceError(tree_->device) != RTC_ERROR_NONE)
        throw Error("Embree cannot build a search tree over the scene");
}

void Stage::trace(const Vec3f& origin, std::span<const Vec3f> directions, std::size_t begin,
                  std::size_t end, HitMap& hits) const noexcept {
    RTCIntersectContext context = coherent_context();
    for (std::size_t first = begin; first < end; first += kPacket) {
        const std::size_t count = std::min(kPacket, end - first);
        alignas(32) RTCRayHit8 packet;
        alignas(32) std::array<int, kPacket> valid{};
        for (std::size_t k = 0; k < kPacket; ++k) {
            const Vec3f& d = directions[first + std::min(k, count - 1)];
            valid[k] = k < count && d.allFinite() ? -1 : 0;
            packet.ray.org_x[k] = origin.x();
            packet.ray.org_y[k] = origin.y();
            packet.ray.org_z[k] = origin.z();
            packet.ray.dir_x[k] = d.x();
            packet.ray.dir_y[k] = d.y();
            packet.ray.dir_z[k] = d.z();
            packet.ray.tnear[k] = 0.0f;
            packet.ray.tfar[k] = std::numeric_limits<float>::infinity();
            packet.ray.time[k] = 0.0f;
            packet.ray.mask[k] = ~0u;
            packet.ray.flags[k] = 0;
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect8(valid.data(), tree_->scene, &context, &packet);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t pixel = first + k;
            if (valid[k] == 0 || packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) {
                hits.depth[pixel] = std::numeric_limits<float>::infinity();
                hits.cosine[pixel] = 0.0f;
                continue;
            }
            hits.depth[pixel] = packet.ray.tfar[k];
            hits.cosine[pixel] = cosine_between(packet.hit.Ng_x[k], packet.hit.Ng_y[k],
                                                packet.hit.Ng_z[k], directions[pixel]);
            hits.surface[pixel] = packet.hit.geomID[k];
            hits.triangle[pixel] = packet.hit.primID[k];
            hits.place[pixel] = {packet.hit.u[k], packet.hit.v[k]};
        }
    }
}

Hit Stage::trace(const Vec3f& origin, const Vec3f& direction) const noexcept {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = origin.x();
    ray.ray.org_y = origin.y();
    ray.ray.org_z = origin.z();
    ray.ray.dir_x = direction.x();
    ray.ray.dir_y = direction.y();
    ray.ray.dir_z = direction.z();
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_->scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {ray.ray.tfar, cosine_between(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z, direction),
            ray.hit.geomID};
}

bool Stage::blocked(const Vec3f& from, const Vec3f& to) const noexcept {
    const Vec3f way = to - from;
    const float length = way.norm();
    if (!(length > 2.0f * kShadowSkin)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    ray.org_x = from.x();
    ray.org_y = from.y();
    ray.org_z = from.z();
    ray.dir_x = way.x();
    ray.dir_y = way.y();
    ray.dir_z = way.z();
    ray.tnear = kShadowSkin / length;
    ray.tfar = 1.0f - kShadowSkin / length;
    ray.mask = ~0u;
    rtcOccluded1(tree_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

} // namespace toile::simulated_sensor
