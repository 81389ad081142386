// The lowest eigenvectors of the Laplace-Beltrami operator: a surface's own coordinates, the same
// in every pose (P3 3.3, Levy 2006).
#pragma once

#include "geometry/mesh.h"

namespace toile::geometry {

struct Spectrum {
    Eigen::VectorXd values;  ///< (k) rising, 1/m^2; the first, 0, is left out
    Eigen::MatrixXd vectors; ///< (nv x k) of mean square 1 over the surface, and mean 0
    Eigen::VectorXd mass;    ///< (nv) share of the area at each vertex, sum 1
};

/// Solves L phi = lambda M phi with the cotangent Laplacian and lumped Voronoi areas for the
/// `count` lowest lambda above 0 (P3 leaves the mass out, so that its vectors hang on the
/// triangulation). Deterministic; signs are as the solver finds them. The surface must be in one
/// piece. \throw Error when the solver fails
[[nodiscard]] Spectrum laplace_beltrami(const TriangleMesh& mesh, int count);

struct Clusters {
    std::vector<std::uint32_t> of; ///< (n) cluster of each row
    Eigen::MatrixXd centres;       ///< (k x d)
    int rounds = 0;
};

/// Lloyd's k-means of weighted rows (n x d) from given first centres (k x d). Clusters keep the
/// numbers of their first centres; one that loses all its rows stays where it is.
[[nodiscard]] Clusters k_means(const Eigen::MatrixXd& rows, const Eigen::VectorXd& weights,
                               const Eigen::MatrixXd& first, int most_rounds = 100);

} // namespace toile::geometry
