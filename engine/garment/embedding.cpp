#include "garment/embedding.h"

#include "geometry/nearest_surface.h"

#include <algorithm>

namespace toile::garment {
namespace {

constexpr float kTiny = 1e-12f;

/// Where a barycentric point lies and the orthonormal frame there.
struct Frame {
    Vec3f origin;
    Vec3f along;
    Vec3f across;
    Vec3f normal;
};

Frame frame_at(const EmbeddedVertex& v, const Triangle& t, std::span<const Vec3f> positions,
               std::span<const Vec3f> normals) noexcept {
    const Vec3f& a = positions[t[0]];
    const Vec3f& b = positions[t[1]];
    const Vec3f& c = positions[t[2]];
    const Vec3f& w = v.barycentric;
    Frame frame;
    frame.origin = w.x() * a + w.y() * b + w.z() * c;
    Vec3f n = w.x() * normals[t[0]] + w.y() * normals[t[1]] + w.z() * normals[t[2]];
    if (n.squaredNorm() < kTiny) n = (b - a).cross(c - a);
    const float length = n.norm();
    frame.normal = length > 0.0f ? Vec3f(n / length) : Vec3f(Vec3f::UnitZ());
    Vec3f e = b - a;
    e -= e.dot(frame.normal) * frame.normal;
    if (e.squaredNorm() < kTiny * (b - a).squaredNorm() + 1e-20f) e = frame.normal.unitOrthogonal();
    frame.along = e.normalized();
    frame.across = frame.normal.cross(frame.along);
    return frame;
}

SurfaceEmbedding::Part embed(const assets::Primitive& primitive, const geometry::TriangleMesh& mesh,
                             const geometry::NearestSurface& nearest,
                             std::span<const Vec3f> normals) {
    SurfaceEmbedding::Part part;
    geometry::SeamedLayout seams;
    const geometry::TriangleMesh welded =
        geometry::weld(primitive.positions, primitive.triangles, {}, seams);
    part.welded = std::move(seams.welded);
    part.triangles = welded.triangles;
    part.vertices.reserve(welded.positions.size());
    for (const Vec3f& p : welded.positions) {
        const auto hit = nearest.nearest(p);
        EmbeddedVertex v;
        v.triangle = hit.triangle;
        v.barycentric = hit.barycentric;
        const Frame frame = frame_at(v, mesh.triangles[v.triangle], mesh.positions, normals);
        const Vec3f d = p - frame.origin;
        v.offset = {d.dot(frame.along), d.dot(frame.across), d.dot(frame.normal)};
        part.max_distance = std::max(part.max_distance, static_cast<double>(d.norm()));
        part.vertices.push_back(v);
    }
    return part;
}

} // namespace

SurfaceEmbedding::SurfaceEmbedding(const GarmentSize& size)
    : simulation_triangles_(size.simulation.triangles) {
    const geometry::NearestSurface nearest(size.simulation.positions, size.simulation.triangles);
    std::vector<Vec3f> normals(size.simulation.positions.size());
    geometry::vertex_normals(size.simulation.positions, size.simulation.triangles, normals);
    for (std::size_t m = 0; m < size.render.meshes.size(); ++m)
        for (std::size_t p = 0; p < size.render.meshes[m].primitives.size(); ++p) {
            parts_.push_back(
                embed(size.render.meshes[m].primitives[p], size.simulation, nearest, normals));
            parts_.back().mesh = m;
            parts_.back().primitive = p;
        }
}

SurfaceEmbedding::Scratch SurfaceEmbedding::make_scratch() const {
    std::size_t largest = 0;
    for (const Part& part : parts_)
        largest = std::max(largest, part.vertices.size());
    return {std::vector<Vec3f>(largest), std::vector<Vec3f>(largest)};
}

void SurfaceEmbedding::evaluate(std::size_t part, std::span<const Vec3f> simulation_positions,
                                std::span<const Vec3f> simulation_normals, Scratch& scratch,
                                std::span<Vec3f> positions,
                                std::span<Vec3f> normals) const noexcept {
    const Part& p = parts_[part];
    const std::span<Vec3f> welded(scratch.positions.data(), p.vertices.size());
    const std::span<Vec3f> welded_normals(scratch.normals.data(), p.vertices.size());
    for (std::size_t i = 0; i < p.vertices.size(); ++i) {
        const EmbeddedVertex& v = p.vertices[i];
        const Frame frame = frame_at(v, simulation_triangles_[v.triangle], simulation_positions,
                                     simulation_normals);
        welded[i] = frame.origin + v.offset.x() * frame.along + v.offset.y() * frame.across +
                    v.offset.z() * frame.normal;
    }
    geometry::vertex_normals(welded, p.triangles, welded_normals);
    for (std::size_t i = 0; i < p.welded.size(); ++i) {
        positions[i] = welded[p.welded[i]];
        normals[i] = welded_normals[p.welded[i]];
    }
}

void SurfaceEmbedding::spread(std::size_t part, std::span<const float> simulation_values,
                              std::span<float> values) const noexcept {
    const Part& p = parts_[part];
    for (std::size_t i = 0; i < p.welded.size(); ++i) {
        const EmbeddedVertex& v = p.vertices[p.welded[i]];
        const Triangle& t = simulation_triangles_[v.triangle];
        values[i] = v.barycentric[0] * simulation_values[t[0]] +
                    v.barycentric[1] * simulation_values[t[1]] +
                    v.barycentric[2] * simulation_values[t[2]];
    }
}

std::vector<Triangle> SurfaceEmbedding::uncovered(std::size_t part,
                                                  std::span<const Triangle> render_triangles,
                                                  std::span<const std::uint8_t> hidden) const {
    const Part& p = parts_[part];
    std::vector<Triangle> out;
    for (const Triangle& t : render_triangles) {
        const bool covered =
            !hidden.empty() && std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
                return hidden[p.vertices[p.welded[v]].triangle] != 0;
            });
        if (!covered) out.push_back(t);
    }
    return out;
}

} // namespace toile::garment
