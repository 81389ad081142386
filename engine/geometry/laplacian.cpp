#include "geometry/laplacian.h"

#include "core/error.h"

#include <algorithm>
#include <vector>

namespace toile::geometry {
namespace {

constexpr double kSliver = 1e-8; // doubled area by longest side squared

// Sides facing corners 0, 1, 2, and twice the area.
struct Shape {
    std::array<Vec3d, 3> sides;
    double doubled_area;

    Shape(std::span<const Vec3f> positions, const Triangle& t) {
        std::array<Vec3d, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = positions[t[k]].cast<double>();
        for (std::size_t k = 0; k < 3; ++k)
            sides[k] = p[(k + 2) % 3] - p[(k + 1) % 3];
        doubled_area = sides[0].cross(sides[1]).norm();
    }
    [[nodiscard]] double guarded_area() const {
        double longest = 0.0;
        for (const Vec3d& side : sides)
            longest = std::max(longest, side.squaredNorm());
        return std::max(doubled_area, kSliver * longest);
    }
    // Cosine at corner k times its two sides' lengths.
    [[nodiscard]] double dot_at(std::size_t k) const {
        return -sides[(k + 1) % 3].dot(sides[(k + 2) % 3]);
    }
};

void check(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    for (const Triangle& t : triangles)
        if (*std::max_element(t.begin(), t.end()) >= positions.size())
            throw Error("a mesh has a triangle with an index out of range");
}

} // namespace

Eigen::SparseMatrix<double> cotangent_laplacian(std::span<const Vec3f> positions,
                                                std::span<const Triangle> triangles) {
    check(positions, triangles);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(12 * triangles.size());
    for (const Triangle& t : triangles) {
        const Shape shape(positions, t);
        const double area = shape.guarded_area();
        if (area <= 0.0) continue; // all three corners in one place: no gradient to speak of
        for (std::size_t k = 0; k < 3; ++k) {
            // The side facing corner k weighs half the cotangent there.
            const double weight = 0.5 * shape.dot_at(k) / area;
            const auto i = static_cast<int>(t[(k + 1) % 3]);
            const auto j = static_cast<int>(t[(k + 2) % 3]);
            entries.emplace_back(i, j, -weight);
            entries.emplace_back(j, i, -weight);
            entries.emplace_back(i, i, weight);
            entries.emplace_back(j, j, weight);
        }
    }
    const auto size = static_cast<Eigen::Index>(positions.size());
    Eigen::SparseMatrix<double> L(size, size);
    L.setFromTriplets(entries.begin(), entries.end());
    return L;
}

Eigen::VectorXd lumped_mass(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                            MassKind kind) {
    check(positions, triangles);
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(positions.size()));
    for (const Triangle& t : triangles) {
        const Shape shape(positions, t);
        const double area = 0.5 * shape.doubled_area;
        std::array<double, 3> share = {area / 3, area / 3, area / 3};
        if (kind == MassKind::voronoi && area > 0.0) {
            std::size_t obtuse = 3;
            for (std::size_t k = 0; k < 3; ++k)
                if (shape.dot_at(k) < 0.0) obtuse = k;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t a = (k + 1) % 3;
                const std::size_t b = (k + 2) % 3;
                if (obtuse == 3)
                    share[k] = (shape.sides[a].squaredNorm() * shape.dot_at(a) +
                                shape.sides[b].squaredNorm() * shape.dot_at(b)) /
                               (8.0 * shape.doubled_area);
                else
                    share[k] = obtuse == k ? area / 2 : area / 4;
            }
        }
        for (std::size_t k = 0; k < 3; ++k)
            mass[static_cast<Eigen::Index>(t[k])] += share[k];
    }
    return mass;
}

} // namespace toile::geometry
