#include "geometry/spectral.h"

#include "core/error.h"
#include "geometry/laplacian.h"

#include <Eigen/SparseCholesky>
#include <Spectra/SymEigsShiftSolver.h>
#include <algorithm>
#include <limits>

namespace toile::geometry {
namespace {

/// What Spectra multiplies with: (A - shift I)^-1. Ours is positive definite, so that a Cholesky
/// factor does, many times faster than Spectra's own LU.
class ShiftedSolve {
  public:
    using Scalar = double;

    explicit ShiftedSolve(const Eigen::SparseMatrix<double>& A) : A_(A) {}

    [[nodiscard]] Eigen::Index rows() const { return A_.rows(); }
    [[nodiscard]] Eigen::Index cols() const { return A_.cols(); }
    void set_shift(double shift) {
        factor_.setShift(-shift);
        factor_.compute(A_);
    }
    void perform_op(const double* x, double* y) const {
        Eigen::Map<Eigen::VectorXd>(y, rows()) =
            factor_.solve(Eigen::Map<const Eigen::VectorXd>(x, rows()));
    }
    [[nodiscard]] bool good() const { return factor_.info() == Eigen::Success; }

  private:
    Eigen::SparseMatrix<double> A_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

constexpr double kShift = -0.05; // 1/m^2, below all eigenvalues

} // namespace

Spectrum laplace_beltrami(const TriangleMesh& mesh, int count) {
    const Eigen::SparseMatrix<double> L = cotangent_laplacian(mesh.positions, mesh.triangles);
    Spectrum out;
    out.mass = lumped_mass(mesh.positions, mesh.triangles);
    const double area = out.mass.sum();
    if (!(area > 0.0)) throw Error("a surface without area has no eigenvectors");
    out.mass = (out.mass / area).cwiseMax(1e-12);
    // Symmetric form: M^-1/2 L M^-1/2.
    const Eigen::VectorXd scale = (out.mass * area).cwiseSqrt().cwiseInverse();
    ShiftedSolve solve(scale.asDiagonal() * L * scale.asDiagonal());
    const int wanted = count + 1;
    const int basis = std::min<int>(static_cast<int>(solve.rows()), std::max(4 * wanted, 24));
    Spectra::SymEigsShiftSolver<ShiftedSolve> solver(solve, wanted, basis, kShift);
    solver.init();
    solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-9, Spectra::SortRule::SmallestAlge);
    if (!solve.good() || solver.info() != Spectra::CompInfo::Successful)
        throw Error("the eigenvectors of a surface cannot be found: its triangles are too uneven");
    out.values = solver.eigenvalues().tail(count);
    out.vectors = (scale * std::sqrt(area)).asDiagonal() * solver.eigenvectors().rightCols(count);
    return out;
}

Clusters k_means(const Eigen::MatrixXd& rows, const Eigen::VectorXd& weights,
                 const Eigen::MatrixXd& first, int most_rounds) {
    Clusters out;
    out.centres = first;
    out.of.assign(static_cast<std::size_t>(rows.rows()), std::numeric_limits<std::uint32_t>::max());
    for (bool moved = true; moved && out.rounds < most_rounds; ++out.rounds) {
        moved = false;
        Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(first.rows(), first.cols());
        Eigen::VectorXd shares = Eigen::VectorXd::Zero(first.rows());
        for (Eigen::Index i = 0; i < rows.rows(); ++i) {
            Eigen::Index best = 0;
            (out.centres.rowwise() - rows.row(i)).rowwise().squaredNorm().minCoeff(&best);
            auto& of = out.of[static_cast<std::size_t>(i)];
            moved = moved || of != best;
            of = static_cast<std::uint32_t>(best);
            sums.row(best) += weights[i] * rows.row(i);
            shares[best] += weights[i];
        }
        for (Eigen::Index c = 0; c < first.rows(); ++c)
            if (shares[c] > 0.0) out.centres.row(c) = sums.row(c) / shares[c];
    }
    return out;
}

} // namespace toile::geometry
