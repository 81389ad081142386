#include "geometry/nearest_surface.h"

#include "core/error.h"
#include "geometry/closest_point.h"
#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <embree3/rtcore.h>
#include <string>
#include <tuple>
#include <vector>

namespace toile::geometry {
namespace {

constexpr std::uint32_t kNoNeighbour = 0xffffffffu;

// For side k (from corner k to corner k + 1) of each triangle the triangle on its other side.
std::vector<std::uint32_t> side_neighbours(std::span<const Triangle> triangles) {
    struct Side {
        std::uint32_t low, high, slot;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[i][k];
            const std::uint32_t b = triangles[i][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), 3 * i + k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
        return std::tie(x.low, x.high, x.slot) < std::tie(y.low, y.high, y.slot);
    });
    std::vector<std::uint32_t> neighbours(sides.size(), kNoNeighbour);
    for (std::size_t i = 0; i + 1 < sides.size(); ++i)
        if (sides[i].low == sides[i + 1].low && sides[i].high == sides[i + 1].high) {
            neighbours[sides[i].slot] = sides[i + 1].slot / 3;
            neighbours[sides[i + 1].slot] = sides[i].slot / 3;
        }
    return neighbours;
}

} // namespace

struct NearestSurface::Tree {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> neighbours; // (3 nf)
    std::vector<Vec3f> face_normals;       // (nf) unit
    std::vector<Vec3f> vertex_normals;     // (nv) angle-weighted, not unit
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr;
    float* vertices = nullptr; // Embree's own copy

    Tree() = default;
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;
    ~Tree() {
        if (geometry != nullptr) rtcReleaseGeometry(geometry);
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }

    void build() {
        device = rtcNewDevice(nullptr);
        if (device == nullptr) throw Error("Embree cannot be started");
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                                               positions.size()));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(Triangle), triangles.size()));
        if (vertices == nullptr || indices == nullptr)
            throw Error("no memory for a search tree over " + std::to_string(triangles.size()) +
                        " triangles");
        for (std::size_t i = 0; i < triangles.size(); ++i)
            std::copy(triangles[i].begin(), triangles[i].end(), indices + 3 * i);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
        update();
        rtcAttachGeometry(scene, geometry);
        rtcCommitScene(scene);
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
            throw Error("Embree cannot build a search tree over " +
                        std::to_string(triangles.size()) + " triangles");
    }

    // Embree's vertices and the normals from `positions`.
    void update() {
        for (std::size_t i = 0; i < positions.size(); ++i)
            std::copy_n(positions[i].data(), 3, vertices + 3 * i);
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
        std::fill(vertex_normals.begin(), vertex_normals.end(), Vec3f::Zero());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const Triangle& t = triangles[i];
            const Vec3f& a = positions[t[0]];
            const Vec3f n = (positions[t[1]] - a).cross(positions[t[2]] - a);
            const float length = n.norm();
            face_normals[i] = length > 0.0f ? Vec3f(n / length) : Vec3f(Vec3f::Zero());
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3f u = positions[t[(k + 1) % 3]] - positions[t[k]];
                const Vec3f v = positions[t[(k + 2) % 3]] - positions[t[k]];
                vertex_normals[t[k]] += std::atan2(u.cross(v).norm(), u.dot(v)) * face_normals[i];
            }
        }
    }

    // Baerentzen and Aanaes 2005: the normal that tells inside from outside at a feature.
    [[nodiscard]] Vec3f pseudo_normal(std::uint32_t triangle, Feature feature) const noexcept {
        Vec3f n = face_normals[triangle];
        if (feature >= Feature::corner0 && feature <= Feature::corner2) {
            const auto k =
                static_cast<std::size_t>(feature) - static_cast<std::size_t>(Feature::corner0);
            n = vertex_normals[triangles[triangle][k]];
        } else if (feature != Feature::face) {
            const auto k =
                static_cast<std::size_t>(feature) - static_cast<std::size_t>(Feature::side01);
            const std::uint32_t other = neighbours[3 * std::size_t{triangle} + k];
            if (other != kNoNeighbour) n += face_normals[other];
        }
        const float length = n.norm();
        return length > 0.0f ? Vec3f(n / length) : face_normals[triangle];
    }
};

namespace {

struct Query {
    const Vec3f* positions;
    const Triangle* triangles;
    Vec3f point;
    float best_squared;
    std::uint32_t triangle = kNoTriangle;
    ClosestPoint closest;
};

// The search radius stays a little above the best distance, so that every triangle at the same
// distance is seen, whatever the tree looks like.
bool visit(RTCPointQueryFunctionArguments* args) {
    Query& query = *static_cast<Query*>(args->userPtr);
    const Triangle& t = query.triangles[args->primID];
    const ClosestPoint candidate = closest_point(query.point, query.positions[t[0]],
                                                 query.positions[t[1]], query.positions[t[2]]);
    const float squared = (candidate.point - query.point).squaredNorm();
    const bool better = squared < query.best_squared ||
                        (squared == query.best_squared && args->primID < query.triangle);
    if (!better) return false;
    query.best_squared = squared;
    query.triangle = args->primID;
    query.closest = candidate;
    const float radius = std::sqrt(squared) * 1.0001f + 1e-7f;
    if (!(radius < args->query->radius)) return false;
    args->query->radius = radius;
    return true;
}

} // namespace

NearestSurface::NearestSurface(std::span<const Vec3f> positions,
                               std::span<const Triangle> triangles)
    : tree_(std::make_unique<Tree>()) {
    for (const Triangle& t : triangles)
        if (*std::max_element(t.begin(), t.end()) >= positions.size())
            throw Error("a surface to search has a triangle with an index out of range");
    for (const Vec3f& p : positions)
        if (!p.allFinite()) throw Error("a surface to search has a vertex that is not finite");
    if (triangles.empty()) throw Error("a surface to search has no triangles");
    tree_->positions.assign(positions.begin(), positions.end());
    tree_->triangles.assign(triangles.begin(), triangles.end());
    tree_->neighbours = side_neighbours(triangles);
    tree_->face_normals.resize(triangles.size());
    tree_->vertex_normals.resize(positions.size());
    tree_->build();
}

NearestSurface::~NearestSurface() = default;
NearestSurface::NearestSurface(NearestSurface&&) noexcept = default;
NearestSurface& NearestSurface::operator=(NearestSurface&&) noexcept = default;

void NearestSurface::refit(std::span<const Vec3f> positions) {
    if (positions.size() != tree_->positions.size())
        throw Error("a surface of " + std::to_string(tree_->positions.size()) +
                    " vertices cannot be refitted with " + std::to_string(positions.size()));
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (positions[i].allFinite()) tree_->positions[i] = positions[i];
    tree_->update();
    rtcCommitScene(tree_->scene);
}

SurfacePoint NearestSurface::nearest(const Vec3f& point, float max_distance) const noexcept {
    SurfacePoint result;
    if (!point.allFinite() || !(max_distance > 0.0f)) return result;
    const float limit = max_distance * max_distance;
    Query query{tree_->positions.data(), tree_->triangles.data(), point, limit, kNoTriangle, {}};
    RTCPointQuery search{};
    search.x = point.x();
    search.y = point.y();
    search.z = point.z();
    search.radius = max_distance * 1.0001f + 1e-7f;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(tree_->scene, &search, &context, visit, &query);
    if (query.triangle == kNoTriangle) return result;
    result.triangle = query.triangle;
    result.barycentric = query.closest.barycentric;
    result.point = query.closest.point;
    result.normal = tree_->pseudo_normal(query.triangle, query.closest.feature);
    result.distance = std::sqrt(query.best_squared);
    result.signed_distance =
        (point - result.point).dot(result.normal) < 0.0f ? -result.distance : result.distance;
    return result;
}

void NearestSurface::nearest(std::span<const Vec3f> points, std::span<SurfacePoint> results,
                             float max_distance) const noexcept {
    for (std::size_t i = 0; i < points.size(); ++i)
        results[i] = nearest(points[i], max_distance);
}

std::optional<RayHit> NearestSurface::first_hit(const Vec3f& origin, const Vec3f& direction,
                                                float from, float to) const noexcept {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = origin.x();
    ray.ray.org_y = origin.y();
    ray.ray.org_z = origin.z();
    ray.ray.dir_x = direction.x();
    ray.ray.dir_y = direction.y();
    ray.ray.dir_z = direction.z();
    ray.ray.tnear = from;
    ray.ray.tfar = to;
    ray.ray.mask = 0xffffffffu;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_->scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const Vec3f weights(1.0f - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v);
    return RayHit{ray.hit.primID, weights, ray.ray.tfar};
}

bool NearestSurface::blocked(const Vec3f& origin, const Vec3f& direction, float from,
                             float to) const noexcept {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.tnear = from;
    ray.tfar = to;
    ray.mask = 0xffffffffu;
    rtcOccluded1(tree_->scene, &context, &ray);
    return ray.tfar < 0.0f; // Embree sets it to -infinity when something is met
}

} // namespace toile::geometry
