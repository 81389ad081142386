#include "scan/volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::scan {
namespace {

constexpr float kLeastWeight = 1e-4f;

std::size_t within(int x, int y, int z) {
    constexpr int kSide = Volume::kSide;
    return static_cast<std::size_t>((z * kSide + y) * kSide + x);
}

int floor_int(float x) {
    return static_cast<int>(std::floor(x));
}

} // namespace

Volume::Volume(const Vec3f& middle, const VolumeOptions& options) : options_(options) {
    const float block = options.voxel_m * kSide;
    side_ = static_cast<int>(std::ceil(2.0f * options.reach_m / block));
    const float half = 0.5f * block * static_cast<float>(side_);
    origin_ = middle - Vec3f::Constant(half);
    const auto side = static_cast<std::size_t>(side_);
    index_.assign(side * side * side, -1);
}

void Volume::allocate(const DepthView& view, const Pose& pose) {
    const Eigen::Isometry3f scan_from_camera = pose.cast<float>();
    const float scale = 1.0f / (options_.voxel_m * kSide);
    const float step = 0.5f * options_.voxel_m * kSide;
    for (int y = 0; y < view.camera.height; y += 2)
        for (int x = 0; x < view.camera.width; x += 2) {
            if (view.depth[view.camera.at(x, y)] == 0.0f) continue;
            const Vec3f at = scan_from_camera * view.point(x, y);
            const Vec3f along = scan_from_camera.linear() * view.normals[view.camera.at(x, y)];
            for (float t = -options_.truncation_m; t < options_.truncation_m + step; t += step) {
                const Vec3f p = scale * (at + std::min(t, options_.truncation_m) * along - origin_);
                const int bx = floor_int(p.x()), by = floor_int(p.y()), bz = floor_int(p.z());
                if (bx < 0 || by < 0 || bz < 0 || bx >= side_ || by >= side_ || bz >= side_)
                    continue;
                allocate(bx, by, bz);
            }
        }
}

/// Number of the block at a place in blocks, made when there is none.
std::int32_t Volume::allocate(int bx, int by, int bz) {
    std::int32_t& slot = index_[static_cast<std::size_t>((bz * side_ + by) * side_ + bx)];
    if (slot >= 0) return slot;
    slot = static_cast<std::int32_t>(blocks_.size());
    blocks_.emplace_back();
    blocks_.back().distance.fill(0.0f);
    blocks_.back().weight.fill(0.0f);
    places_.emplace_back(kSide * bx, kSide * by, kSide * bz);
    return slot;
}

void Volume::update(Block& block, const Eigen::Vector3i& place, const DepthView& view,
                    const Eigen::Isometry3f& camera_from_scan) const {
    const float truncation = options_.truncation_m;
    const Vec3f corner = origin_ + options_.voxel_m * place.cast<float>();
    const Vec3f step = options_.voxel_m * camera_from_scan.linear().col(0);
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y) {
            Vec3f p =
                camera_from_scan * (corner + options_.voxel_m * Vec3f(0.0f, static_cast<float>(y),
                                                                      static_cast<float>(z)));
            for (int x = 0; x < kSide; ++x, p += step) {
                int u = 0, v = 0;
                if (!view.camera.pixel(p, u, v)) continue;
                const std::size_t i = view.camera.at(u, v);
                const float depth = view.depth[i];
                if (depth == 0.0f || view.weight[i] <= 0.0f) continue;
                const float along_ray = depth + p.z(); // positive: before the surface
                if (along_ray < -truncation || along_ray > truncation) continue;
                const Vec3f seen = view.point(u, v);
                const float distance = view.normals[i].dot(p - seen);
                if (distance < -truncation || distance > truncation) continue;
                const std::size_t at = within(x, y, z);
                // Behind a surface a reading fades, or thin parts would grow by what is seen of
                // their other side.
                const float fade = distance < 0.0f ? 1.0f + distance / truncation : 1.0f;
                const float before = block.weight[at], weight = view.weight[i] * fade * fade;
                if (!(weight > 0.0f)) continue;
                block.weight[at] = before + weight;
                block.distance[at] =
                    (before * block.distance[at] + weight * distance) / (before + weight);
            }
        }
}

void Volume::integrate(const DepthView& view, const Pose& scan_from_camera, const RowLoop& rows) {
    allocate(view, scan_from_camera);
    const Eigen::Isometry3f camera_from_scan = scan_from_camera.inverse().cast<float>();
    const float half = 0.5f * options_.voxel_m * kSide;
    const float radius = std::sqrt(3.0f) * half;
    rows(static_cast<std::uint32_t>(blocks_.size()), 256,
         [&](std::uint32_t begin, std::uint32_t end) {
             for (std::uint32_t b = begin; b < end; ++b) {
                 const Vec3f middle =
                     camera_from_scan * (origin_ + options_.voxel_m * places_[b].cast<float>() +
                                         Vec3f::Constant(half));
                 const Window& c = view.camera;
                 if (middle.z() > -0.1f) continue;
                 const float u = c.cx - c.fx * middle.x() / middle.z(),
                             v = c.cy + c.fy * middle.y() / middle.z(),
                             margin = -std::max(c.fx, c.fy) * radius / middle.z();
                 if (u < -margin || v < -margin || u > static_cast<float>(c.width) + margin ||
                     v > static_cast<float>(c.height) + margin)
                     continue;
                 update(blocks_[b], places_[b], view, camera_from_scan);
             }
         });
}

void Volume::add(std::span<const Reading> readings, float radius_m, const RowLoop& rows) {
    const float truncation = options_.truncation_m;
    const float reach = std::sqrt(radius_m * radius_m + truncation * truncation);
    const float scale = 1.0f / (options_.voxel_m * kSide);
    // Which readings each block gets, in their order.
    std::vector<std::vector<std::uint32_t>> of_block(blocks_.size());
    for (std::uint32_t i = 0; i < readings.size(); ++i) {
        const Vec3f low = scale * (readings[i].point - Vec3f::Constant(reach) - origin_),
                    high = scale * (readings[i].point + Vec3f::Constant(reach) - origin_);
        for (int bz = floor_int(low.z()); bz <= floor_int(high.z()); ++bz)
            for (int by = floor_int(low.y()); by <= floor_int(high.y()); ++by)
                for (int bx = floor_int(low.x()); bx <= floor_int(high.x()); ++bx) {
                    if (bx < 0 || by < 0 || bz < 0 || bx >= side_ || by >= side_ || bz >= side_)
                        continue;
                    const auto b = static_cast<std::size_t>(allocate(bx, by, bz));
                    if (b >= of_block.size()) of_block.resize(b + 1);
                    of_block[b].push_back(i);
                }
    }
    rows(static_cast<std::uint32_t>(of_block.size()), 64,
         [&](std::uint32_t begin, std::uint32_t end) {
             for (std::uint32_t b = begin; b < end; ++b)
                 for (const std::uint32_t i : of_block[b])
                     splat(blocks_[b], places_[b], readings[i], radius_m);
         });
}

void Volume::splat(Block& block, const Eigen::Vector3i& place, const Reading& reading,
                   float radius) const {
    const float truncation = options_.truncation_m, voxel = options_.voxel_m;
    const Vec3f at = (reading.point - origin_) / voxel - place.cast<float>(); // in voxels
    // The disc's box: along the normal the truncation, across it the radius.
    Eigen::Vector3i low, high;
    for (int k = 0; k < 3; ++k) {
        const float along = std::abs(reading.normal[k]),
                    half = (truncation * along + radius * std::sqrt(1.0f - along * along)) / voxel;
        low[k] = std::max(0, static_cast<int>(std::ceil(at[k] - half)));
        high[k] = std::min(kSide - 1, floor_int(at[k] + half));
    }
    const float inverse = 1.0f / (radius * radius);
    for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
            for (int x = low.x(); x <= high.x(); ++x) {
                const Vec3f off = voxel * (Vec3f(static_cast<float>(x), static_cast<float>(y),
                                                 static_cast<float>(z)) -
                                           at);
                const float distance = reading.normal.dot(off);
                if (distance < -truncation || distance > truncation) continue;
                const float across = (off.squaredNorm() - distance * distance) * inverse;
                if (across >= 1.0f) continue;
                const float fade = distance < 0.0f ? 1.0f + distance / truncation : 1.0f;
                const float near = 1.0f - across;
                const float weight = reading.weight * near * near * fade * fade;
                if (!(weight > 0.0f)) continue;
                const std::size_t i = within(x, y, z);
                const float before = block.weight[i];
                block.weight[i] = before + weight;
                block.distance[i] =
                    (before * block.distance[i] + weight * distance) / (before + weight);
            }
}

bool Volume::voxel(int x, int y, int z, float& distance, float& weight) const {
    const Block* block = block_at(x >> 3, y >> 3, z >> 3);
    if (block == nullptr) return false;
    const std::size_t at = within(x & 7, y & 7, z & 7);
    distance = block->distance[at];
    weight = block->weight[at];
    return weight > kLeastWeight;
}

bool Volume::sample(const Vec3f& point, float& distance) const {
    Vec3f unused;
    return sample(point, distance, unused);
}

bool Volume::sample(const Vec3f& point, float& distance, Vec3f& slope) const {
    const Vec3f p = (point - origin_) / options_.voxel_m;
    const int x = floor_int(p.x()), y = floor_int(p.y()), z = floor_int(p.z());
    float d[8], weight = 0.0f;
    const Block* block = block_at(x >> 3, y >> 3, z >> 3);
    if ((x & 7) < 7 && (y & 7) < 7 && (z & 7) < 7) {
        if (block == nullptr) return false;
        for (int k = 0; k < 8; ++k) {
            const std::size_t at =
                within((x & 7) + (k & 1), (y & 7) + ((k >> 1) & 1), (z & 7) + (k >> 2));
            if (block->weight[at] <= kLeastWeight) return false;
            d[k] = block->distance[at];
        }
    } else {
        for (int k = 0; k < 8; ++k)
            if (!voxel(x + (k & 1), y + ((k >> 1) & 1), z + (k >> 2), d[k], weight)) return false;
    }
    const float a = p.x() - static_cast<float>(x), b = p.y() - static_cast<float>(y),
                c = p.z() - static_cast<float>(z);
    const auto mix = [](float s, float t, float at) { return s + at * (t - s); };
    const float x00 = mix(d[0], d[1], a), x10 = mix(d[2], d[3], a), x01 = mix(d[4], d[5], a),
                x11 = mix(d[6], d[7], a);
    const float y0 = mix(x00, x10, b), y1 = mix(x01, x11, b);
    distance = mix(y0, y1, c);
    slope = {mix(mix(d[1] - d[0], d[3] - d[2], b), mix(d[5] - d[4], d[7] - d[6], b), c),
             mix(x10 - x00, x11 - x01, c), y1 - y0};
    const float length = slope.norm();
    if (!(length > 1e-6f)) return false;
    slope /= length;
    return true;
}

namespace {

/// Where a ray crosses from outside to inside; NaN: nowhere.
float crossing(const Volume& volume, const Vec3f& from, const Vec3f& along, float near, float far) {
    const float voxel = volume.options().voxel_m;
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    float before = 0.0f, last = nothing;
    bool known = false;
    for (float t = near; t < far;) {
        float distance = 0.0f;
        if (volume.sample(from + t * along, distance)) {
            if (known && before > 0.0f && distance <= 0.0f)
                return last + (t - last) * before / (before - distance);
            before = distance;
            last = t;
            known = true;
            t += std::max(voxel, 0.7f * std::abs(distance));
        } else {
            known = false;
            t += 2.0f * voxel;
        }
    }
    return nothing;
}

} // namespace

namespace {

/// Nearest and farthest reading within a few pixels; nothing: far 0.
struct Depths {
    float near = std::numeric_limits<float>::infinity(), far = 0.0f;
};

Depths depths_around(const DepthView& view, int x, int y, int stride) {
    Depths out;
    const int reach = 2 * stride;
    for (int v = y - reach; v <= y + reach; v += stride)
        for (int u = x - reach; u <= x + reach; u += stride) {
            if (u < 0 || v < 0 || u >= view.camera.width || v >= view.camera.height) continue;
            const float depth = view.depth[view.camera.at(u, v)];
            if (depth == 0.0f) continue;
            out.near = std::min(out.near, depth);
            out.far = std::max(out.far, depth);
        }
    return out;
}

} // namespace

SurfaceMap raycast(const Volume& volume, const DepthView& view, int stride, float reach_m,
                   const Pose& scan_from_camera, const RowLoop& rows) {
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    const Window& camera = view.camera;
    const auto scale = 1.0f / static_cast<float>(stride);
    SurfaceMap out;
    out.camera = {camera.width / stride, camera.height / stride, camera.fx * scale,
                  camera.fy * scale,     camera.cx * scale,      camera.cy * scale};
    out.points.assign(out.camera.count(), Vec3f::Constant(nothing));
    out.normals = out.points;
    const Eigen::Isometry3f pose = scan_from_camera.cast<float>();
    const auto line = [&](int y) {
        for (int x = 0; x < out.camera.width; ++x) {
            const Depths depths = depths_around(view, x * stride, y * stride, stride);
            if (depths.far == 0.0f) continue;
            const Vec3f from = pose.translation(),
                        along = pose.linear() *
                                out.camera.ray(static_cast<float>(x), static_cast<float>(y));
            const float t = crossing(volume, from, along, std::max(0.1f, depths.near - reach_m),
                                     depths.far + reach_m);
            float distance = 0.0f;
            Vec3f slope;
            if (!(t > 0.0f) || !volume.sample(from + t * along, distance, slope)) continue;
            out.points[out.camera.at(x, y)] = from + t * along;
            out.normals[out.camera.at(x, y)] = slope;
        }
    };
    rows(static_cast<std::uint32_t>(out.camera.height), 8,
         [&](std::uint32_t begin, std::uint32_t end) {
             for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                 line(y);
         });
    return out;
}

std::vector<float> predicted_depth(const Volume& volume, const DepthView& view,
                                   const Pose& scan_from_camera) {
    const Warp pose = scan_from_camera.matrix().topRows<3>().cast<float>();
    return predicted_depth(volume, view, [&](std::size_t) { return pose; });
}

std::vector<float> predicted_depth(const Volume& volume, const DepthView& view,
                                   const std::function<Warp(std::size_t pixel)>& scan_from_camera) {
    const float reach = 1.5f * volume.options().truncation_m;
    std::vector<float> out(view.depth.size(), 0.0f);
    for (int y = 0; y < view.camera.height; ++y)
        for (int x = 0; x < view.camera.width; ++x) {
            const std::size_t i = view.camera.at(x, y);
            if (view.raw[i] == 0.0f) continue;
            const Warp pose = scan_from_camera(i);
            if (!pose.allFinite()) continue;
            const Vec3f along =
                pose.leftCols<3>() * view.camera.ray(static_cast<float>(x), static_cast<float>(y));
            const float t =
                crossing(volume, pose.col(3), along, view.raw[i] - reach, view.raw[i] + reach);
            if (t > 0.0f) out[i] = t;
        }
    return out;
}

} // namespace toile::scan
