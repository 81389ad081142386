#include "geometry/laplacian.h"

#include "core/random.h"
#include "geometry/mesh.h"
#include "support/meshes.h"
#include "support/throws.h"

#include <Eigen/Eigenvalues>
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/MatOp/SymShiftInvert.h>
#include <Spectra/SymGEigsShiftSolver.h>
#include <gtest/gtest.h>

namespace toile::geometry {
namespace {

// A grid with its inner vertices moved about in the plane: obtuse and thin triangles included.
TriangleMesh uneven_grid() {
    TriangleMesh mesh = test::grid(1.0f, 1.0f, 9, 9);
    Random random(11);
    for (Vec3f& p : mesh.positions)
        if (p.x() > 0.01f && p.x() < 0.99f && p.y() > 0.01f && p.y() < 0.99f)
            p += Vec3f(static_cast<float>(random.uniform(-0.04, 0.04)),
                       static_cast<float>(random.uniform(-0.04, 0.04)), 0.0f);
    return mesh;
}

TEST(Laplacian, LinearFunctionsAreHarmonicOnAFlatMesh) {
    const TriangleMesh mesh = uneven_grid();
    const Eigen::SparseMatrix<double> L = cotangent_laplacian(mesh.positions, mesh.triangles);
    Eigen::VectorXd f(L.rows());
    for (Eigen::Index i = 0; i < f.size(); ++i) {
        const Vec3d p = mesh.positions[static_cast<std::size_t>(i)].cast<double>();
        f[i] = 3.0 * p.x() - 2.0 * p.y() + 1.0;
    }
    const Eigen::VectorXd Lf = L * f;
    for (Eigen::Index i = 0; i < f.size(); ++i) {
        const Vec3f& p = mesh.positions[static_cast<std::size_t>(i)];
        const bool inner = p.x() > 0.01f && p.x() < 0.99f && p.y() > 0.01f && p.y() < 0.99f;
        if (inner) {
            EXPECT_NEAR(Lf[i], 0.0, 1e-6);
        }
    }
    // The energy of a linear function is its squared gradient times the area.
    EXPECT_NEAR(f.dot(Lf), 13.0, 1e-5);
}

TEST(Laplacian, SymmetricAndPositiveSemiDefinite) {
    TriangleMesh mesh = test::sphere(1.0f, 2);
    Random random(3); // crumple it, so that obtuse angles occur
    for (Vec3f& p : mesh.positions)
        p *= static_cast<float>(random.uniform(0.6, 1.4));
    mesh.positions[5] = mesh.positions[9]; // and slivers
    const Eigen::MatrixXd L = cotangent_laplacian(mesh.positions, mesh.triangles);
    EXPECT_EQ((L - L.transpose()).cwiseAbs().maxCoeff(), 0.0);
    EXPECT_TRUE(L.allFinite());
    const double scale = L.cwiseAbs().maxCoeff();
    EXPECT_LT((L * Eigen::VectorXd::Ones(L.rows())).cwiseAbs().maxCoeff(), 1e-12 * scale);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(L, Eigen::EigenvaluesOnly);
    EXPECT_GT(solver.eigenvalues()[0], -1e-10 * scale);
    EXPECT_GT(L.diagonal().minCoeff(), 0.0); // our sign
}

TEST(Laplacian, OneZeroEigenvalueAndTheSpheresSpectrum) {
    const TriangleMesh mesh = test::sphere(1.0f, 4);
    const Eigen::SparseMatrix<double> L = cotangent_laplacian(mesh.positions, mesh.triangles);
    const Eigen::VectorXd mass = lumped_mass(mesh.positions, mesh.triangles);
    Eigen::SparseMatrix<double> M(L.rows(), L.cols());
    M.reserve(Eigen::VectorXi::Constant(L.cols(), 1));
    for (Eigen::Index i = 0; i < mass.size(); ++i)
        M.insert(i, i) = mass[i];

    using Inverse = Spectra::SymShiftInvert<double, Eigen::Sparse, Eigen::Sparse>;
    using Product = Spectra::SparseSymMatProd<double>;
    Inverse inverse(L, M);
    Product product(M);
    Spectra::SymGEigsShiftSolver<Inverse, Product, Spectra::GEigsMode::ShiftInvert> solver(
        inverse, product, 9, 30, -1e-2);
    solver.init();
    ASSERT_GE(
        solver.compute(Spectra::SortRule::LargestMagn, 500, 1e-9, Spectra::SortRule::SmallestAlge),
        9);
    const Eigen::VectorXd values = solver.eigenvalues();
    // l (l + 1) with multiplicity 2 l + 1: 0; 2 x 3; 6 x 5.
    EXPECT_NEAR(values[0], 0.0, 1e-7);
    for (int i = 1; i <= 3; ++i)
        EXPECT_NEAR(values[i], 2.0, 0.03);
    for (int i = 4; i <= 8; ++i)
        EXPECT_NEAR(values[i], 6.0, 0.1);
}

TEST(Mass, SumsToTheArea) {
    for (const TriangleMesh& mesh : {uneven_grid(), test::sphere(0.4f, 3)})
        for (const MassKind kind : {MassKind::barycentric, MassKind::voronoi}) {
            const Eigen::VectorXd mass = lumped_mass(mesh.positions, mesh.triangles, kind);
            EXPECT_NEAR(mass.sum(), surface_area(mesh), 1e-9);
            EXPECT_GT(mass.minCoeff(), 0.0);
        }
}

TEST(Mass, VoronoiCellsOfASquareGrid) {
    const TriangleMesh mesh = test::grid(1.0f, 1.0f, 4, 4);
    const Eigen::VectorXd mass = lumped_mass(mesh.positions, mesh.triangles);
    EXPECT_NEAR(mass[6], 1.0 / 16.0, 1e-7); // inner
    EXPECT_NEAR(mass[1], 1.0 / 32.0, 1e-7); // side
    EXPECT_NEAR(mass[0], 1.0 / 64.0, 1e-7); // corner
    const Eigen::VectorXd thirds =
        lumped_mass(mesh.positions, mesh.triangles, MassKind::barycentric);
    EXPECT_NEAR(thirds[0], 2.0 * (1.0 / 32.0) / 3.0, 1e-7); // two triangles meet there
}

TEST(Laplacian, IndicesOutOfRangeAreRefused) {
    TriangleMesh mesh = test::grid(1, 1, 1, 1);
    mesh.triangles[0][0] = 77;
    EXPECT_ERROR((void)cotangent_laplacian(mesh.positions, mesh.triangles), "out of range");
    EXPECT_ERROR((void)lumped_mass(mesh.positions, mesh.triangles), "out of range");
}

} // namespace
} // namespace toile::geometry
