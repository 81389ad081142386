#include "mesh_garment/smooth_field.h"

#include "core/error.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace toile::mesh_garment {

SurfaceOperator surface_operator(std::span<const Vec3f> positions,
                                 std::span<const Triangle> triangles) {
    // Slivers have huge or negative cotangents; within these bounds the operator stays a
    // convex smoothing, which matters more here than exactness.
    constexpr double kLeast = 0.05;
    constexpr double kMost = 8.0;
    const auto n = static_cast<Eigen::Index>(positions.size());
    SurfaceOperator out;
    out.areas = Eigen::VectorXd::Constant(n, 1e-10);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(12 * triangles.size());
    for (const Triangle& t : triangles) {
        const std::array<Vec3d, 3> p = {positions[t[0]].cast<double>(),
                                        positions[t[1]].cast<double>(),
                                        positions[t[2]].cast<double>()};
        const double doubled = (p[1] - p[0]).cross(p[2] - p[0]).norm();
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d& apex = p[k];
            const double dot = (p[(k + 1) % 3] - apex).dot(p[(k + 2) % 3] - apex);
            const double w = 0.5 * std::clamp(dot / std::max(doubled, 1e-12), kLeast, kMost);
            const auto i = static_cast<Eigen::Index>(t[(k + 1) % 3]);
            const auto j = static_cast<Eigen::Index>(t[(k + 2) % 3]);
            entries.emplace_back(i, i, w);
            entries.emplace_back(j, j, w);
            entries.emplace_back(i, j, -w);
            entries.emplace_back(j, i, -w);
            out.areas[static_cast<Eigen::Index>(t[k])] += doubled / 6.0;
        }
    }
    out.laplacian.resize(n, n);
    out.laplacian.setFromTriplets(entries.begin(), entries.end());
    return out;
}

Eigen::MatrixXd fill_smoothly(const SurfaceOperator& surface, const Eigen::MatrixXd& values,
                              const Eigen::VectorXd& trust, double length) {
    const Eigen::VectorXd weight = surface.areas.cwiseProduct(trust);
    const double stiffness = length * length * length * length;
    Eigen::SparseMatrix<double> system =
        stiffness * (surface.laplacian.transpose() * surface.areas.cwiseInverse().asDiagonal() *
                     surface.laplacian);
    system.diagonal() += weight;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
    if (solver.info() != Eigen::Success)
        throw Error("a smooth field over the garment has no solution");
    return solver.solve(weight.asDiagonal() * values);
}

} // namespace toile::mesh_garment
