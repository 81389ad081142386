#include "laplace_beltrami_resize/follow_body.h"

#include "core/error.h"
#include "geometry/laplacian.h"
#include "geometry/nearest_surface.h"

#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <cmath>

namespace toile::laplace_beltrami_resize {
namespace {

constexpr double kLeastSmoothing = 0.002; // metres over which moves are smoothed on the skin
constexpr double kSmoothingByGap = 1.0;   // and per metre of distance from it
constexpr int kRoomRounds = 2;
constexpr float kMostRoomStep = 0.02f; // metres a round

/// How the skin around each vertex turns.
std::vector<Mat3f> turns(const geometry::TriangleMesh& before, std::span<const Vec3f> after) {
    const std::size_t count = before.positions.size();
    std::vector<Mat3f> sums(count, Mat3f::Zero());
    for (const Triangle& t : before.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            const Mat3f term =
                (after[b] - after[a]) * (before.positions[b] - before.positions[a]).transpose();
            sums[a] += term;
            sums[b] += term;
        }
    // The ring around, too: single rings are nearly flat.
    std::vector<Mat3f> wide = sums;
    for (const Triangle& t : before.triangles)
        for (const std::uint32_t v : t)
            for (const std::uint32_t w : t)
                wide[v] += sums[w];
    std::vector<Mat3f> out(count, Mat3f::Identity());
    for (std::size_t v = 0; v < count; ++v) {
        const Eigen::JacobiSVD<Mat3f> svd(wide[v], Eigen::ComputeFullU | Eigen::ComputeFullV);
        Mat3f turn = svd.matrixU() * svd.matrixV().transpose();
        if (turn.determinant() < 0.0f) {
            Mat3f u = svd.matrixU();
            u.col(2) *= -1.0f;
            turn = u * svd.matrixV().transpose();
        }
        out[v] = turn;
    }
    return out;
}

/// Fields on a surface that are smoothed the wider, the farther it is from the body: the minimum
/// of sum A w |u - given|^2 + integral |grad u|^2 with w = 1 / length^2.
class GapSmoother {
  public:
    GapSmoother(const geometry::TriangleMesh& mesh, std::span<const float> gaps)
        : weights_(geometry::lumped_mass(mesh.positions, mesh.triangles)) {
        Eigen::SparseMatrix<double> A =
            geometry::cotangent_laplacian(mesh.positions, mesh.triangles);
        for (Eigen::Index v = 0; v < weights_.size(); ++v) {
            const double gap =
                kSmoothingByGap * static_cast<double>(std::abs(gaps[static_cast<std::size_t>(v)]));
            weights_[v] =
                std::max(weights_[v], 1e-10) / (kLeastSmoothing * kLeastSmoothing + gap * gap);
            A.coeffRef(v, v) += weights_[v];
        }
        solver_.compute(A);
        if (solver_.info() != Eigen::Success)
            throw Error("moves cannot be smoothed over the surface: it has parts without area");
    }

    /// Each of the three columns by itself.
    void smooth(std::vector<Vec3f>& moves, const RowLoop& rows) const {
        rows(3, 1, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t k = first; k < last; ++k)
                smooth_column(moves, static_cast<Eigen::Index>(k));
        });
    }

  private:
    void smooth_column(std::vector<Vec3f>& moves, Eigen::Index k) const {
        Eigen::VectorXd one(static_cast<Eigen::Index>(moves.size()));
        for (std::size_t v = 0; v < moves.size(); ++v)
            one[static_cast<Eigen::Index>(v)] = static_cast<double>(moves[v][k]);
        one = solver_.solve(weights_.cwiseProduct(one)).eval();
        for (std::size_t v = 0; v < moves.size(); ++v)
            moves[v][k] = static_cast<float>(one[static_cast<Eigen::Index>(v)]);
    }

    Eigen::VectorXd weights_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

constexpr std::uint32_t kGrain = 2048;

} // namespace

std::vector<Vec3f> follow_body(const geometry::TriangleMesh& subject,
                               const geometry::TriangleMesh& before, std::span<const Vec3f> after,
                               const RowLoop& rows) {
    if (after.size() != before.positions.size())
        throw Error("the body after the change has " + std::to_string(after.size()) +
                    " vertices, before it had " + std::to_string(before.positions.size()));
    const geometry::NearestSurface skin(before.positions, before.triangles);
    const std::vector<Mat3f> turn = turns(before, after);
    const auto count = static_cast<std::uint32_t>(subject.positions.size());
    std::vector<Vec3f> moves(count);
    std::vector<float> gaps(count);
    rows(count, kGrain, [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t v = first; v < last; ++v) {
            const Vec3f& p = subject.positions[v];
            const auto near = skin.nearest(p);
            const Triangle& t = before.triangles[near.triangle];
            gaps[v] = near.signed_distance;
            Vec3f place = Vec3f::Zero();
            for (std::size_t k = 0; k < 3; ++k)
                place += near.barycentric[static_cast<Eigen::Index>(k)] *
                         (after[t[k]] + turn[t[k]] * (p - near.point));
            moves[v] = place - p;
        }
    });
    const GapSmoother smoother(subject, gaps);
    smoother.smooth(moves, rows);
    std::vector<Vec3f> out(count);
    for (std::uint32_t v = 0; v < count; ++v)
        out[v] = subject.positions[v] + moves[v];
    // What smoothing took from the room to the body is given back.
    const geometry::NearestSurface changed(after, before.triangles);
    for (int round = 0; round < kRoomRounds; ++round) {
        std::vector<Vec3f> pushes(count);
        rows(count, kGrain, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t v = first; v < last; ++v) {
                const auto near = changed.nearest(out[v]);
                const float lack =
                    std::clamp(gaps[v] - near.signed_distance, -kMostRoomStep, kMostRoomStep);
                const Vec3f away = near.signed_distance < 0.0f ? Vec3f(near.point - out[v])
                                                               : Vec3f(out[v] - near.point);
                pushes[v] =
                    lack * (near.distance > 0.003f ? Vec3f(away / near.distance) : near.normal);
            }
        });
        smoother.smooth(pushes, rows); // as vectors: between two legs they point apart
        for (std::uint32_t v = 0; v < count; ++v)
            out[v] += pushes[v];
    }
    return out;
}

} // namespace toile::laplace_beltrami_resize
