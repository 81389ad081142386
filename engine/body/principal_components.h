// Principal components of long rows under any metric, by subspace iteration on their small side.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace toile::body {

/// row ~ mean + components * coefficients, the coefficients of the rows having deviation 1.
struct PrincipalComponents {
    Eigen::VectorXf mean;       ///< (d)
    Eigen::MatrixXf components; ///< (d x k) per deviation, orthogonal in the metric, largest first
    Eigen::VectorXd deviation;  ///< (k) length of each in the metric
    double total = 0.0;         ///< variance of the rows in the metric, all of it

    /// Best coefficients of a row in the metric they were made with. (k)
    [[nodiscard]] Eigen::VectorXd project(const Eigen::VectorXf& row,
                                          const Eigen::SparseMatrix<float>& metric) const;
};

/// `rows` (n x d), n > k; `metric` (d x d) symmetric, positive semi-definite: coordinates that it
/// gives no weight follow along. The sign makes the largest coordinate of each component positive.
/// Deterministic. \throw Error when there are not enough rows
[[nodiscard]] PrincipalComponents
principal_components(Eigen::MatrixXf rows, const Eigen::SparseMatrix<float>& metric, int count);

} // namespace toile::body
