#include "body/principal_components.h"

#include "core/error.h"
#include "core/random.h"

#include <Eigen/Dense>

namespace toile::body {
namespace {

constexpr int kSpare = 20;  // directions beyond those wanted, so that the last ones converge
constexpr int kSweeps = 12; // each shrinks what is left by the ratio of eigenvalues

} // namespace

Eigen::VectorXd PrincipalComponents::project(const Eigen::VectorXf& row,
                                             const Eigen::SparseMatrix<float>& metric) const {
    const Eigen::VectorXf weighted = metric * (row - mean);
    return (components.transpose() * weighted).cast<double>().cwiseQuotient(deviation.cwiseAbs2());
}

PrincipalComponents principal_components(Eigen::MatrixXf rows,
                                         const Eigen::SparseMatrix<float>& metric, int count) {
    const auto n = static_cast<int>(rows.rows());
    if (n <= count) throw Error("too few rows for " + std::to_string(count) + " components");
    PrincipalComponents out;
    out.mean = rows.colwise().mean();
    rows.rowwise() -= out.mean.transpose();
    const auto gram_times = [&](const Eigen::MatrixXf& v) -> Eigen::MatrixXf {
        const Eigen::MatrixXf along = rows.transpose() * v;
        const Eigen::MatrixXf weighted = metric * along;
        return rows * weighted;
    };
    for (int i = 0; i < n; ++i) {
        const Eigen::VectorXf row = rows.row(i);
        out.total += static_cast<double>(row.dot(metric * row)) / n;
    }

    // Orthonormal combinations of people that the Gram matrix keeps among themselves.
    const int width = std::min(n - 1, count + kSpare);
    Eigen::MatrixXf basis(n, width);
    Random random(1);
    for (int j = 0; j < width; ++j)
        for (int i = 0; i < n; ++i)
            basis(i, j) = static_cast<float>(random.normal());
    const auto orthonormal = [](const Eigen::MatrixXf& m) -> Eigen::MatrixXf {
        return Eigen::HouseholderQR<Eigen::MatrixXf>(m).householderQ() *
               Eigen::MatrixXf::Identity(m.rows(), m.cols());
    };
    basis = orthonormal(basis);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        basis = orthonormal(gram_times(basis));
    const Eigen::MatrixXd small = (basis.transpose() * gram_times(basis)).cast<double>();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (small + small.transpose()));

    const Eigen::MatrixXf leading =
        basis * eigen.eigenvectors().rightCols(count).rowwise().reverse().cast<float>();
    out.components = rows.transpose() * leading / std::sqrt(static_cast<float>(n));
    out.deviation = (eigen.eigenvalues().tail(count).reverse() / n).cwiseMax(0.0).cwiseSqrt();
    for (int k = 0; k < count; ++k) {
        Eigen::Index largest = 0;
        out.components.col(k).cwiseAbs().maxCoeff(&largest);
        if (out.components(largest, k) < 0.0f) out.components.col(k) *= -1.0f;
    }
    return out;
}

} // namespace toile::body
