#include "mesh_garment/clearance.h"

#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>

namespace toile::mesh_garment {
namespace {

constexpr int kRounds = 240;
constexpr int kSmoothRounds = 60;   // of them, in which the surroundings give way too
constexpr float kMargin = 0.0003f;  // metres beyond the ease that is aimed at
constexpr float kOverRelax = 1.15f; // speeds up points that pull on each other

/// A point of the garment that must be clear: the mean of one, two or three vertices.
struct Sample {
    std::array<std::uint32_t, 3> vertices;
    std::uint32_t count;
    float slack = 0.0f; ///< metres it may still move before it has to be looked at again
};

std::vector<Sample> make_samples(std::size_t vertex_count, std::span<const Triangle> triangles,
                                 const geometry::VertexAdjacency& rows) {
    std::vector<Sample> samples;
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        samples.push_back({{v, v, v}, 1});
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        for (std::uint32_t k = rows.first[v]; k < rows.first[v + 1]; ++k)
            if (rows.neighbours[k] > v) samples.push_back({{v, rows.neighbours[k], v}, 2});
    for (const Triangle& t : triangles)
        samples.push_back({t, 3});
    return samples;
}

Vec3f place(const Sample& sample, std::span<const Vec3f> positions) {
    Vec3f p = positions[sample.vertices[0]];
    for (std::uint32_t k = 1; k < sample.count; ++k)
        p += positions[sample.vertices[k]];
    return p / static_cast<float>(sample.count);
}

/// Where each vertex is pushed: means of the pushes of its samples, the deeper counting more.
struct Pushes {
    std::vector<Vec3f> sum;
    std::vector<float> weight;

    explicit Pushes(std::size_t n) : sum(n), weight(n) {}
    void clear() {
        std::fill(sum.begin(), sum.end(), Vec3f::Zero());
        std::fill(weight.begin(), weight.end(), 0.0f);
    }
    void add(const Sample& sample, const Vec3f& push) {
        const float depth = push.norm();
        for (std::uint32_t k = 0; k < sample.count; ++k) {
            sum[sample.vertices[k]] += depth * push;
            weight[sample.vertices[k]] += depth;
        }
    }
    void finish() {
        for (std::size_t v = 0; v < sum.size(); ++v)
            if (weight[v] > 0.0f) sum[v] *= kOverRelax / weight[v];
    }
};

Vec3f push_out(const SurfacePoint& at, const Vec3f& p, float depth) {
    // Outside, away from the nearest point; at the skin and inside, along its normal.
    if (at.signed_distance > 1e-3f) return depth * (p - at.point) / at.signed_distance;
    return depth * at.normal;
}

/// Vertices that are not pushed follow their neighbours by half, some rings far.
void give_way(const geometry::VertexAdjacency& rows, Pushes& pushes) {
    constexpr int kRings = 6;
    std::vector<Vec3f> next = pushes.sum;
    for (int ring = 0; ring < kRings; ++ring) {
        for (std::size_t v = 0; v < next.size(); ++v) {
            const std::uint32_t count = rows.first[v + 1] - rows.first[v];
            if (pushes.weight[v] > 0.0f || count == 0) continue;
            Vec3f mean = Vec3f::Zero();
            for (std::uint32_t k = rows.first[v]; k < rows.first[v + 1]; ++k)
                mean += pushes.sum[rows.neighbours[k]];
            next[v] = 0.85f * mean / static_cast<float>(count);
        }
        pushes.sum = next;
    }
}

ClearanceReport measure(const BodySurface& body, const std::vector<Sample>& samples, float ease,
                        std::span<const Vec3f> positions) {
    ClearanceReport report;
    report.least_m = 1e9f;
    for (const Sample& sample : samples) {
        const float distance = body.nearest(place(sample, positions)).signed_distance;
        report.least_m = std::min(report.least_m, distance);
        if (distance < ease && sample.count != 2) ++report.short_of_ease;
    }
    return report;
}

} // namespace

ClearanceReport clear_body(const BodySurface& body, std::span<const Triangle> triangles, float ease,
                           std::span<Vec3f> positions) {
    const auto rows = geometry::vertex_adjacency(positions.size(), triangles);
    std::vector<Sample> samples = make_samples(positions.size(), triangles, rows);
    Pushes pushes(positions.size());
    int round = 0;
    float moved = 0.0f; // by any vertex, summed over the rounds
    for (; round < kRounds; ++round) {
        pushes.clear();
        bool clear = true;
        for (Sample& sample : samples) {
            if (sample.slack > moved) continue;
            const Vec3f p = place(sample, positions);
            const SurfacePoint at = body.nearest(p);
            sample.slack = moved + std::max(0.0f, at.signed_distance - ease - kMargin);
            if (at.signed_distance >= ease) continue;
            clear = false;
            pushes.add(sample, push_out(at, p, ease + kMargin - at.signed_distance));
        }
        if (clear) break;
        pushes.finish();
        if (round < kSmoothRounds) give_way(rows, pushes);
        float most = 0.0f;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            positions[v] += pushes.sum[v];
            most = std::max(most, pushes.sum[v].norm());
        }
        moved += most;
    }
    ClearanceReport report = measure(body, samples, ease, positions);
    report.rounds = round;
    return report;
}

} // namespace toile::mesh_garment
