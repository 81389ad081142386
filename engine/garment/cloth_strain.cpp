#include "garment/cloth_strain.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace toile::garment {
namespace {

constexpr int kWeft = 0; // u
constexpr int kWarp = 1; // v

float mean_of(const Triangle& t, std::span<const float> values) {
    return (values[t[0]] + values[t[1]] + values[t[2]]) / 3.0f;
}

} // namespace

ClothStrain::ClothStrain(std::span<const Triangle> triangles,
                         std::span<const Vec2f> material_coords, std::size_t vertex_count)
    : triangles_(triangles.begin(), triangles.end()), vertex_area_(vertex_count, 0.0f),
      warp_(triangles.size(), 0.0f), weft_(triangles.size(), 0.0f),
      vertex_warp_(vertex_count, 0.0f), vertex_weft_(vertex_count, 0.0f),
      pressure_(vertex_count, 0.0f), force_(vertex_count, 0.0f), area_(vertex_count, 0.0f) {
    if (material_coords.size() != 3 * triangles.size())
        throw Error("cloth strain: " + std::to_string(material_coords.size()) +
                    " material coordinates for " + std::to_string(triangles.size()) + " triangles");
    rest_.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (const std::uint32_t v : triangles[i])
            if (v >= vertex_count)
                throw Error("cloth strain: triangle " + std::to_string(i) +
                            " names a vertex out of range");
        Eigen::Matrix2f sides;
        sides.col(0) = material_coords[3 * i + 1] - material_coords[3 * i];
        sides.col(1) = material_coords[3 * i + 2] - material_coords[3 * i];
        const float area = 0.5f * std::abs(sides.determinant());
        if (!(area > 0.0f))
            throw Error("cloth strain: triangle " + std::to_string(i) + " has no rest area");
        const Eigen::Matrix2f inverse = sides.inverse();
        rest_.push_back({inverse.row(0), inverse.row(1), area});
        for (const std::uint32_t v : triangles[i])
            vertex_area_[v] += area;
    }
    around_ = geometry::vertex_adjacency(vertex_count, triangles);
}

Vec3f ClothStrain::along(std::size_t triangle, int axis,
                         std::span<const Vec3f> positions) const noexcept {
    const Triangle& t = triangles_[triangle];
    const Rest& rest = rest_[triangle];
    const Vec3f& corner = positions[t[0]];
    return rest.first[axis] * (positions[t[1]] - corner) +
           rest.second[axis] * (positions[t[2]] - corner);
}

void ClothStrain::measure(std::span<const Vec3f> positions) noexcept {
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        warp_[i] = along(i, kWarp, positions).norm() - 1.0f;
        weft_[i] = along(i, kWeft, positions).norm() - 1.0f;
    }
    average_at_vertices();
}

void ClothStrain::average_at_vertices() noexcept {
    std::fill(vertex_warp_.begin(), vertex_warp_.end(), 0.0f);
    std::fill(vertex_weft_.begin(), vertex_weft_.end(), 0.0f);
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        for (const std::uint32_t v : triangles_[i]) {
            const float share = rest_[i].area / vertex_area_[v];
            vertex_warp_[v] += share * warp_[i];
            vertex_weft_[v] += share * weft_[i];
        }
}

void ClothStrain::add_forces(std::size_t triangle, std::span<const Vec3f> positions,
                             std::span<const Vec3f> normals,
                             const StretchStiffness& stiffness) noexcept {
    const Triangle& t = triangles_[triangle];
    const Rest& rest = rest_[triangle];
    const std::array<Vec2f, 3> gradients = {-(rest.first + rest.second), rest.first, rest.second};
    for (const int axis : {kWeft, kWarp}) {
        // Of the strain around, not of this triangle alone: a solver's noise would look like force.
        const float strain = mean_of(t, axis == kWarp ? vertex_warp_ : vertex_weft_);
        const double n_m = axis == kWarp ? stiffness.warp_n_m : stiffness.weft_n_m;
        if (strain <= 0.0f) continue;
        const Vec3f way = along(triangle, axis, positions).normalized();
        const float pull = rest.area * static_cast<float>(n_m) * strain;
        for (std::size_t k = 0; k < 3; ++k)
            force_[t[k]] += pull * gradients[k][axis] * way.dot(normals[t[k]]);
    }
    const Vec3f& corner = positions[t[0]];
    const float area = 0.5f * (positions[t[1]] - corner).cross(positions[t[2]] - corner).norm();
    for (const std::uint32_t v : t)
        area_[v] += area / 3.0f;
}

void ClothStrain::measure_pressure(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                   const StretchStiffness& stiffness) noexcept {
    std::fill(force_.begin(), force_.end(), 0.0f);
    std::fill(area_.begin(), area_.end(), 0.0f);
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        add_forces(i, positions, normals, stiffness);
    // Over a vertex and its neighbours, so that what pushes on one and pulls on the next is even.
    for (std::size_t v = 0; v < pressure_.size(); ++v) {
        float force = force_[v], area = area_[v];
        for (std::uint32_t k = around_.first[v]; k < around_.first[v + 1]; ++k) {
            force += force_[around_.neighbours[k]];
            area += area_[around_.neighbours[k]];
        }
        pressure_[v] = area > 0.0f ? std::max(0.0f, force / area) : 0.0f;
    }
}

StrainFigures ClothStrain::figures() const noexcept {
    StrainFigures out;
    double squares = 0.0;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const double warp = static_cast<double>(warp_[i]), weft = static_cast<double>(weft_[i]);
        const auto area = static_cast<double>(rest_[i].area);
        squares += 0.5 * area * (warp * warp + weft * weft);
        out.rest_area += area;
        out.max = std::max({out.max, warp, weft});
    }
    if (out.rest_area > 0.0) out.rms = std::sqrt(squares / out.rest_area);
    return out;
}

} // namespace toile::garment
