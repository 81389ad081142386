#include "garment/layering.h"

#include "geometry/nearest_surface.h"

#include <algorithm>

namespace toile::garment {
namespace {

constexpr float kReach_m = 0.12f;       // farther garments are not one above the other
constexpr float kBorderFull_m = 0.015f; // beside the inner garment's border the push fades out
constexpr float kBorderNone_m = 0.06f;
constexpr float kMostPush_m = 0.10f;
constexpr int kRounds = 6; // of spreading a push, and pushing what is still too low
constexpr int kSpreads = 3;

Vec3f mean(const std::array<std::uint32_t, 3>& vertices, std::uint32_t count,
           std::span<const Vec3f> positions) {
    Vec3f sum = positions[vertices[0]];
    for (std::uint32_t k = 1; k < count; ++k)
        sum += positions[vertices[k]];
    return sum / static_cast<float>(count);
}

} // namespace

LayerOffset::LayerOffset(const LayerSurface& inner, const LayerSurface& outer)
    : walk_(inner.triangles, inner.positions.size()),
      around_(geometry::vertex_adjacency(outer.positions.size(), outer.triangles)),
      inner_(inner.positions.size()), moved_(outer.positions.size()),
      spread_(outer.positions.size()), share_(outer.positions.size()) {
    const geometry::NearestSurface surface(inner.positions, inner.triangles);
    const auto add = [&](const std::array<std::uint32_t, 3>& vertices, std::uint32_t count) {
        const auto found = surface.nearest(mean(vertices, count, outer.positions), kReach_m);
        if (found.triangle != geometry::kNoTriangle)
            samples_.push_back({vertices, count, found.triangle});
    };
    for (const Triangle& corner : outer.triangles)
        add(corner, 3);
    for (std::uint32_t v = 0; v < outer.positions.size(); ++v)
        add({v, v, v}, 1);
    planes_.resize(samples_.size());
}

LayerOffset::Plane LayerOffset::plane_beneath(const Vec3f& p, std::span<const Vec3f> inner_normals,
                                              Sample& sample) const noexcept {
    const auto found = walk_.walk(inner_, Vec4f(p.x(), p.y(), p.z(), 0.0f), sample.beneath);
    if (found.triangle == geometry::kNoTriangle) return {Vec3f::Zero(), 0.0f, 0.0f};
    sample.beneath = found.triangle;
    Vec3f normal = Vec3f::Zero();
    for (std::size_t k = 0; k < 3; ++k)
        normal += found.bary[k] * inner_normals[walk_.triangles()[found.triangle][k]];
    const float length = normal.norm();
    if (length < 1e-6f) return {Vec3f::Zero(), 0.0f, 0.0f};
    normal /= length;
    const Vec3f point = found.point.head<3>();
    const Vec3f away = p - point;
    const float beside = (away - away.dot(normal) * normal).norm();
    const float weight =
        std::clamp((kBorderNone_m - beside) / (kBorderNone_m - kBorderFull_m), 0.0f, 1.0f);
    return {normal, normal.dot(point), weight};
}

/// Draws each vertex's push towards its neighbours'.
void LayerOffset::spread() noexcept {
    for (int i = 0; i < kSpreads; ++i) {
        for (std::size_t v = 0; v < moved_.size(); ++v) {
            const std::uint32_t first = around_.first[v];
            const std::uint32_t last = around_.first[v + 1];
            Vec3f sum = Vec3f::Zero();
            for (std::uint32_t k = first; k < last; ++k)
                sum += moved_[around_.neighbours[k]];
            const float count = static_cast<float>(std::max(1u, last - first));
            spread_[v] = 0.5f * moved_[v] + (0.5f / count) * sum;
        }
        moved_.swap(spread_);
    }
}

void LayerOffset::push_out(float gap_m, std::span<const Vec3f> outer) noexcept {
    for (std::size_t s = 0; s < samples_.size(); ++s) {
        const Plane& plane = planes_[s];
        const Sample& sample = samples_[s];
        const Vec3f p = mean(sample.vertices, sample.count, outer) +
                        mean(sample.vertices, sample.count, moved_);
        const float low = gap_m - (plane.normal.dot(p) - plane.height);
        const float push = plane.weight * std::clamp(low, 0.0f, kMostPush_m);
        if (push <= 0.0f) continue;
        for (std::uint32_t k = 0; k < sample.count; ++k)
            moved_[sample.vertices[k]] += push * plane.normal;
    }
}

void LayerOffset::apply(std::span<const Vec3f> inner, std::span<const Vec3f> inner_normals,
                        float gap_m, std::span<Vec3f> outer) noexcept {
    for (std::size_t v = 0; v < inner.size(); ++v)
        inner_[v] << inner[v], 0.0f;
    std::fill(share_.begin(), share_.end(), 0.0f);
    for (std::size_t s = 0; s < samples_.size(); ++s) {
        Sample& sample = samples_[s];
        planes_[s] =
            plane_beneath(mean(sample.vertices, sample.count, outer), inner_normals, sample);
        if (sample.count == 1) share_[sample.vertices[0]] = planes_[s].weight;
    }
    std::fill(moved_.begin(), moved_.end(), Vec3f::Zero());
    for (int round = 0; round < kRounds; ++round) {
        if (round > 0) spread();
        push_out(gap_m, outer);
    }
    for (std::size_t v = 0; v < outer.size(); ++v)
        outer[v] += share_[v] * moved_[v];
}

} // namespace toile::garment
