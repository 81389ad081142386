#include "scape_fit/free_form.h"

#include "core/error.h"
#include "geometry/laplacian.h"

#include <numbers>

namespace toile::scape_fit {
namespace {

// Of what a point says: an outline is as exact, but its pixels stand for less of the surface.
constexpr double kOutlineShare = 0.5;

} // namespace

FreeForm::FreeForm(const FitLevel& full)
    : level_(full), laplacian_(geometry::cotangent_laplacian(full.mean, full.triangles)),
      mass_(geometry::lumped_mass(full.mean, full.triangles, geometry::MassKind::barycentric)) {}

void FreeForm::solve(std::span<const PosedLevel* const> posed,
                     std::span<const Association* const> associations,
                     const FreeFormOptions& options, std::vector<float>& offsets) {
    const auto n = static_cast<int>(level_.vertices.size());
    offsets.resize(level_.vertices.size(), 0.0f);
    // Lindgren, Rue, Lindstrom 2011, alpha = 2: Q = tau^2 K' M^-1 K, K = kappa^2 M + L; in two
    // dimensions the variance is 1 / (4 pi kappa^2 tau^2) and the range sqrt(8) / kappa.
    const double kappa = std::sqrt(8.0) / options.correlation_m;
    const double tau2 =
        1.0 / (4.0 * std::numbers::pi * kappa * kappa * options.deviation_m * options.deviation_m);
    Eigen::SparseMatrix<double> K = laplacian_;
    K.diagonal() += kappa * kappa * mass_;
    Eigen::SparseMatrix<double> system =
        tau2 * (K.transpose() * mass_.cwiseInverse().asDiagonal() * K);
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(n), right = Eigen::VectorXd::Zero(n);
    for (std::size_t a = 0; a < associations.size(); ++a)
        for (const VertexPair& pair : associations[a]->pairs) {
            if (pair.kind != PairKind::skin && pair.kind != PairKind::outline) continue;
            const double share = pair.kind == PairKind::outline ? kOutlineShare : 1.0;
            const auto v = static_cast<int>(pair.vertex);
            // How far the place moves along the pair's normal by a unit of offset.
            const double along = pair.normal.dot(posed[a]->rotations[pair.vertex] *
                                                 level_.mean_normals[pair.vertex]);
            const double w = options.information * share * pair.weight;
            weight[v] += w * along * along;
            right[v] += w * along * (along * offsets[pair.vertex] - pair.distance);
        }
    system += Eigen::SparseMatrix<double>(weight.asDiagonal());
    if (!analysed_) solver_.analyzePattern(system);
    analysed_ = true;
    solver_.factorize(system);
    if (solver_.info() != Eigen::Success) throw Error("free form: the system cannot be factored");
    const Eigen::VectorXd solved = solver_.solve(right);
    for (int v = 0; v < n; ++v)
        offsets[static_cast<std::size_t>(v)] = static_cast<float>(solved[v]);
}

} // namespace toile::scape_fit
