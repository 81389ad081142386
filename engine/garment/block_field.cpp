#include "garment/block_field.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace toile::garment::block {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Normals that decide inside from outside at faces, edges and vertices (angle-weighted).
struct PseudoNormals {
    std::vector<Vec3d> faces, vertices;
    std::map<Edge, Vec3d> edges;

    explicit PseudoNormals(const geometry::TriangleMesh& surface)
        : vertices(surface.positions.size(), Vec3d::Zero()) {
        for (const Triangle& t : surface.triangles) {
            std::array<Vec3d, 3> p;
            for (int k = 0; k < 3; ++k) {
                p[k] = surface.positions[t[k]].cast<double>();
            }
            const Vec3d n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
            faces.push_back(n);
            for (int k = 0; k < 3; ++k) {
                const Vec3d u = (p[(k + 1) % 3] - p[k]).normalized();
                const Vec3d v = (p[(k + 2) % 3] - p[k]).normalized();
                vertices[t[k]] += std::acos(std::clamp(u.dot(v), -1.0, 1.0)) * n;
                edges.try_emplace(std::minmax(t[k], t[(k + 1) % 3]), Vec3d::Zero())
                    .first->second += n;
            }
        }
    }

    [[nodiscard]] const Vec3d& at(const Triangle& t, const std::size_t face,
                                  const Vec3d& weights) const {
        constexpr double kZero = 1e-9;
        for (int k = 0; k < 3; ++k) {
            if (weights[k] > 1.0 - kZero) {
                return vertices[t[k]];
            }
        }
        for (int k = 0; k < 3; ++k) {
            if (weights[k] < kZero) {
                return edges.at(std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]));
            }
        }
        return faces[face];
    }
};

} // namespace

Vec3d closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                          Vec3d& weights) {
    const Vec3d ab = b - a;
    const Vec3d ac = c - a;
    const Vec3d n = ab.cross(ac);
    const double area2 = n.squaredNorm();
    // Inside the prism over the triangle: barycentric coordinates of the projection.
    weights[2] = ab.cross(p - a).dot(n) / area2;
    weights[1] = (p - a).cross(ac).dot(n) / area2;
    weights[0] = 1.0 - weights[1] - weights[2];
    if (weights.minCoeff() >= 0.0) {
        return weights[0] * a + weights[1] * b + weights[2] * c;
    }
    const std::array<const Vec3d*, 3> corner = {&a, &b, &c};
    double best = std::numeric_limits<double>::infinity();
    Vec3d closest = a;
    for (int k = 0; k < 3; ++k) {
        const Vec3d& from = *corner[k];
        const Vec3d along = *corner[(k + 1) % 3] - from;
        const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        const Vec3d q = from + t * along;
        if ((q - p).squaredNorm() < best) {
            best = (q - p).squaredNorm();
            closest = q;
            weights.setZero();
            weights[k] = 1.0 - t;
            weights[(k + 1) % 3] = t;
        }
    }
    return closest;
}

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
    constexpr float kUnknown = std::numeric_limits<float>::infinity();
    values_.assign(static_cast<std::size_t>(nodes), kUnknown);
    const PseudoNormals normals(surface);
    for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
        const Triangle& t = surface.triangles[f];
        const Vec3d a = surface.positions[t[0]].cast<double>();
        const Vec3d b = surface.positions[t[1]].cast<double>();
        const Vec3d c = surface.positions[t[2]].cast<double>();
        const Vec3d box_low = (a.cwiseMin(b).cwiseMin(c) - low_).array() - reach_m;
        const Vec3d box_high = (a.cwiseMax(b).cwiseMax(c) - low_).array() + reach_m;
        std::array<int, 3> from{};
        std::array<int, 3> to{};
        for (int k = 0; k < 3; ++k) {
            from[k] = std::max(0, static_cast<int>(box_low[k] / cell_m));
            to[k] = std::min(size_[k] - 1, static_cast<int>(box_high[k] / cell_m) + 1);
        }
        for (int z = from[2]; z <= to[2]; ++z) {
            for (int y = from[1]; y <= to[1]; ++y) {
                for (int x = from[0]; x <= to[0]; ++x) {
                    const Vec3d p = low_ + cell_m * Vec3d(x, y, z);
                    Vec3d weights;
                    const Vec3d q = closest_on_triangle(p, a, b, c, weights);
                    const double d = (p - q).norm();
                    float& value = values_[index(x, y, z)];
                    if (d < std::min(reach_m, static_cast<double>(std::abs(value)))) {
                        const bool outside = (p - q).dot(normals.at(t, f, weights)) >= 0.0;
                        value = static_cast<float>(outside ? d : -d);
                    }
                }
            }
        }
    }
    // Beyond the reach: inside or outside as the last known value along x says.
    for (int z = 0; z < size_[2]; ++z) {
        for (int y = 0; y < size_[1]; ++y) {
            float last = static_cast<float>(reach_m);
            for (int x = 0; x < size_[0]; ++x) {
                float& value = values_[index(x, y, z)];
                value = value == kUnknown ? std::copysign(static_cast<float>(reach_m), last) : value;
                last = value;
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
    gradient.x() = mix(mix(v[1] - v[0], v[3] - v[2], f.y()), mix(v[5] - v[4], v[7] - v[6], f.y()),
                       f.z());
    gradient.y() = mix(mix(v[2] - v[0], v[3] - v[1], f.x()), mix(v[6] - v[4], v[7] - v[5], f.x()),
                       f.z());
    gradient.z() = y1 - y0;
    const double size = gradient.norm();
    if (size > 1e-12) {
        gradient /= size;
    }
    return mix(y0, y1, f.z());
}

} // namespace toile::garment::block
