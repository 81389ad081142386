// Eigenvalues against the sphere's closed form; eigenvectors' norms; k-means on known clusters.
#include "geometry/spectral.h"

#include "geometry/cut.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

namespace toile::geometry {
namespace {

TEST(Spectral, ASpheresEigenvaluesAreKnown) {
    constexpr double kRadius = 0.5; // l (l + 1) / r^2: three of 8, five of 24
    const Spectrum s = laplace_beltrami(test::sphere(0.5f, 4), 8);
    for (int k = 0; k < 8; ++k) {
        const double wanted = (k < 3 ? 2.0 : 6.0) / (kRadius * kRadius);
        EXPECT_NEAR(s.values[k], wanted, 0.02 * wanted) << k;
    }
}

TEST(Spectral, VectorsAreOrthonormalOverTheSurface) {
    const Spectrum s = laplace_beltrami(test::tube(0.2f, 0.3f, 1.5f, 30, 60), 4);
    EXPECT_NEAR(s.mass.sum(), 1.0, 1e-9);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(s.mass.dot(s.vectors.col(i)), 0.0, 1e-6);
        for (int j = 0; j < 4; ++j)
            EXPECT_NEAR(s.vectors.col(i).cwiseProduct(s.mass).dot(s.vectors.col(j)),
                        i == j ? 1.0 : 0.0, 1e-6);
    }
}

TEST(Spectral, ScaleAndPlaceDoNotMatterToVectors) {
    const TriangleMesh tube = test::tube(0.2f, 0.3f, 1.5f, 30, 60);
    TriangleMesh other = tube;
    for (Vec3f& p : other.positions)
        p = 2.0f * p + Vec3f(1.0f, 2.0f, 3.0f);
    const Spectrum a = laplace_beltrami(tube, 1), b = laplace_beltrami(other, 1);
    EXPECT_NEAR(a.values[0], 4.0 * b.values[0], 1e-3 * a.values[0]);
    EXPECT_LT((a.vectors.cwiseAbs() - b.vectors.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(KMeans, KnownClustersKeepTheNumbersOfTheirFirstCentres) {
    Eigen::MatrixXd rows(6, 1), first(2, 1);
    rows << 0.0, 0.1, 0.2, 5.0, 5.1, 5.5;
    first << 4.0, 1.0;
    const Clusters c = k_means(rows, Eigen::VectorXd::Ones(6), first);
    EXPECT_EQ(c.of, (std::vector<std::uint32_t>{1, 1, 1, 0, 0, 0}));
    EXPECT_NEAR(c.centres(0, 0), 5.2, 1e-12);
    EXPECT_NEAR(c.centres(1, 0), 0.1, 1e-12);
}

TEST(Cut, TwoHalvesSewnTogetherAreWholeAgain) {
    const TriangleMesh ball = test::sphere(0.5f, 4);
    std::vector<float> above, below;
    for (const Vec3f& p : ball.positions) {
        above.push_back(p.y() - 0.103f);
        below.push_back(0.1f - p.y());
    }
    const CutMesh top = cut_where(ball, above), bottom = cut_where(ball, below);
    ASSERT_EQ(rims(top.mesh).size(), 1u);
    ASSERT_EQ(rims(bottom.mesh).size(), 1u);
    TriangleMesh whole = bottom.mesh;
    const auto base = static_cast<std::uint32_t>(whole.positions.size());
    whole.positions.insert(whole.positions.end(), top.mesh.positions.begin(),
                           top.mesh.positions.end());
    for (const Triangle& t : top.mesh.triangles)
        whole.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    auto upper = rims(top.mesh).front();
    for (std::uint32_t& v : upper)
        v += base;
    const auto seam = sew_rims(whole.positions, rims(bottom.mesh).front(), upper, Vec3f::Zero());
    whole.triangles.insert(whole.triangles.end(), seam.begin(), seam.end());
    EXPECT_TRUE(check_topology(whole.positions, whole.triangles).closed())
        << check_topology(whole.positions, whole.triangles).text();
    EXPECT_NEAR(volume(whole), volume(ball), 0.002 * volume(ball));
}

} // namespace
} // namespace toile::geometry
