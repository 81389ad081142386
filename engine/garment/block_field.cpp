#include "garment/block_field.h"

#include "core/error.h"
#include "geometry/nearest_surface.h"

#include <cmath>

namespace toile::garment::block {
DistanceField::DistanceField(const geometry::TriangleMesh& surface, const double cell_m,
                             const double reach_m)
    : cell_(cell_m), reach_(reach_m) {
    Vec3d low = surface.positions.front().cast<double>();
    Vec3d high = low;
    for (const Vec3f& p : surface.positions) {
        low = low.cwiseMin(p.cast<double>());
        high = high.cwiseMax(p.cast<double>());
    }
    low_ = low.array() - reach_m - 2.0 * cell_m;
    for (int k = 0; k < 3; ++k) {
        size_[k] = static_cast<int>((high[k] - low_[k] + reach_m) / cell_m) + 3;
    }
    const double nodes = static_cast<double>(size_[0]) * size_[1] * size_[2];
    if (nodes > 5e7) {
        throw Error("the body is too large for a distance grid of " + std::to_string(cell_m) +
                    " m cells: is it in metres?");
    }
    values_.resize(static_cast<std::size_t>(nodes));
    const geometry::NearestSurface nearest(surface.positions, surface.triangles);
    const auto reach = static_cast<float>(reach_m);
    for (int z = 0; z < size_[2]; ++z) {
        for (int y = 0; y < size_[1]; ++y) {
            // Beyond the reach: inside or outside as the last known value along x says.
            float last = reach;
            for (int x = 0; x < size_[0]; ++x) {
                const Vec3d p = low_ + cell_m * Vec3d(x, y, z);
                const auto hit = nearest.nearest(p.cast<float>(), reach);
                const bool found = hit.triangle != geometry::kNoTriangle;
                last = found ? hit.signed_distance : std::copysign(reach, last);
                values_[index(x, y, z)] = last;
            }
        }
    }
}

double DistanceField::at(const Vec3d& p, Vec3d& gradient) const {
    const Vec3d g = (p - low_) / cell_;
    gradient.setZero();
    std::array<int, 3> i{};
    for (int k = 0; k < 3; ++k) {
        i[k] = static_cast<int>(std::floor(g[k]));
        if (i[k] < 0 || i[k] + 1 >= size_[k]) {
            return reach_;
        }
    }
    const Vec3d f(g.x() - i[0], g.y() - i[1], g.z() - i[2]);
    std::array<double, 8> v{};
    for (int k = 0; k < 8; ++k) {
        v[k] = values_[index(i[0] + (k & 1), i[1] + (k >> 1 & 1), i[2] + (k >> 2))];
    }
    const auto mix = [](const double a, const double b, const double t) { return a + t * (b - a); };
    const double y0 = mix(mix(v[0], v[1], f.x()), mix(v[2], v[3], f.x()), f.y());
    const double y1 = mix(mix(v[4], v[5], f.x()), mix(v[6], v[7], f.x()), f.y());
    gradient.x() =
        mix(mix(v[1] - v[0], v[3] - v[2], f.y()), mix(v[5] - v[4], v[7] - v[6], f.y()), f.z());
    gradient.y() =
        mix(mix(v[2] - v[0], v[3] - v[1], f.x()), mix(v[6] - v[4], v[7] - v[5], f.x()), f.z());
    gradient.z() = y1 - y0;
    const double size = gradient.norm();
    if (size > 1e-12) {
        gradient /= size;
    }
    return mix(y0, y1, f.z());
}

} // namespace toile::garment::block
