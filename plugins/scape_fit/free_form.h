// The last step of a fit: the model's surface moves onto the detail that its components cannot
// show (P1 3.2's deformation of the model onto the scan, P5 eq. 24).
#pragma once

#include "scape_fit/association.h"

#include <Eigen/SparseCholesky>

namespace toile::scape_fit {

/// How the surface may differ from the model: a random field along the normals, Gaussian with this
/// deviation and correlated over this length (Matern, as a sparse precision: Lindgren 2011).
struct FreeFormOptions {
    double deviation_m = 0.004;
    double correlation_m = 0.15;
    /// What the points say for each square metre, 1/m^2 per m^2: their density by their variance.
    double information = 5e7;
};

/// Keeps the mean body's matrices.
class FreeForm {
  public:
    explicit FreeForm(const FitLevel& full);

    /// Most likely offsets (nv) given the pairs of all instants (`posed`: their surfaces, in which
    /// `offsets` already are).
    void solve(std::span<const PosedLevel* const> posed,
               std::span<const Association* const> associations, const FreeFormOptions& options,
               std::vector<float>& offsets);

  private:
    const FitLevel& level_;
    Eigen::SparseMatrix<double> laplacian_;
    Eigen::VectorXd mass_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
    bool analysed_ = false;
};

} // namespace toile::scape_fit
