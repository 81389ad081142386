#include "geometry/clean_up.h"

#include "core/error.h"
#include "geometry/clean_up_parts.h"
#include "geometry/laplacian.h"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>

namespace toile::geometry {
namespace {

void smooth(CleanMesh& out, const CleanUpOptions& options) {
    const std::vector<Vec3f> before = out.mesh.positions;
    for (int i = 0; i < options.smoothing_rounds && options.smoothing > 0.0; ++i)
        out.mesh.positions = smoothed(out.mesh, options.smoothing);
    double sum = 0.0;
    for (std::size_t v = 0; v < before.size(); ++v)
        sum += static_cast<double>((out.mesh.positions[v] - before[v]).squaredNorm());
    out.report.smoothing_rms_m = std::sqrt(sum / static_cast<double>(before.size()));
}

} // namespace

std::vector<Vec3f> smoothed(const TriangleMesh& mesh, double lambda) {
    // Rows of K are those of L over their own sum of weights; times that sum the system is
    // symmetric: (D + lambda L) X' = D X. Weights below nought (obtuse pairs) are left out.
    const auto size = static_cast<Eigen::Index>(mesh.positions.size());
    Eigen::SparseMatrix<double> A = cotangent_laplacian(mesh.positions, mesh.triangles);
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(size);
    for (int column = 0; column < A.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator it(A, column); it; ++it) {
            if (it.row() == it.col() || it.value() >= 0.0) continue;
            sums[it.row()] -= it.value();
            entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(it.col()),
                                 lambda * it.value());
        }
    for (Eigen::Index v = 0; v < size; ++v) {
        const double sum = std::max(sums[v], 1e-9);
        entries.emplace_back(static_cast<int>(v), static_cast<int>(v), sum + lambda * sums[v]);
        sums[v] = sum;
    }
    A.setFromTriplets(entries.begin(), entries.end());
    // Strongly diagonal: a few sweeps of conjugate gradients from where the points are.
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(1e-6);
    solver.setMaxIterations(60);
    solver.compute(A);
    std::vector<Vec3f> out(mesh.positions.size());
    for (int k = 0; k < 3; ++k) {
        Eigen::VectorXd x(size);
        for (Eigen::Index v = 0; v < size; ++v)
            x[v] = static_cast<double>(mesh.positions[static_cast<std::size_t>(v)][k]);
        const Eigen::VectorXd solved = solver.solveWithGuess(sums.cwiseProduct(x), x);
        if (!solved.allFinite()) throw Error("a surface cannot be smoothed");
        for (Eigen::Index v = 0; v < size; ++v)
            out[static_cast<std::size_t>(v)][k] = static_cast<float>(solved[v]);
    }
    return out;
}

CleanMesh clean_up(const TriangleMesh& scan, const CleanUpOptions& options) {
    CleanMesh out;
    merge_points(scan, options.merge_m, out);
    drop_bad_triangles(out);
    drop_extra_at_edges(out);
    orient_alike(out);
    keep_largest_piece(out);
    if (out.mesh.triangles.size() < 4)
        throw Error("nothing of the surface is left after its clean-up: it has no piece of "
                    "connected triangles");
    split_pinched_vertices(out);
    fill_holes(options.largest_hole, out);
    if (volume(out.mesh) < 0.0)
        for (Triangle& t : out.mesh.triangles)
            std::swap(t[1], t[2]);
    smooth(out, options);
    out.mesh.normals.resize(out.mesh.positions.size());
    vertex_normals(out.mesh.positions, out.mesh.triangles, out.mesh.normals);
    return out;
}

} // namespace toile::geometry
