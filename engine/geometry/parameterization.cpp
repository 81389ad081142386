#include "geometry/parameterization.h"

#include "core/error.h"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace toile::geometry {
namespace {

using Vec2d = Eigen::Vector2d;
using Sparse = Eigen::SparseMatrix<double>;
using Solver = Eigen::SimplicialLDLT<Sparse>;

/// A triangle laid in the plane without distortion.
std::array<Vec2d, 3> laid_flat(std::span<const Vec3f> positions, const Triangle& t) {
    const Vec3d a = positions[t[0]].cast<double>(), b = positions[t[1]].cast<double>(),
                c = positions[t[2]].cast<double>();
    const Vec3d x = (b - a).normalized();
    const double along = (c - a).dot(x);
    return {Vec2d(0.0, 0.0), Vec2d((b - a).norm(), 0.0),
            Vec2d(along, ((c - a) - along * x).norm())};
}

double signed_area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

bool all_upright(std::span<const Triangle> triangles, const std::vector<Vec2d>& uv) {
    return std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
        return signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) > 0.0;
    });
}

/// Two far ends of the piece: the vertex farthest from the first, and the one farthest from that.
std::pair<std::uint32_t, std::uint32_t> far_pair(std::span<const Vec3f> positions) {
    const auto farthest = [&](std::uint32_t from) {
        std::uint32_t best = 0;
        for (std::uint32_t v = 0; v < positions.size(); ++v)
            if ((positions[v] - positions[from]).squaredNorm() >
                (positions[best] - positions[from]).squaredNorm())
                best = v;
        return best;
    };
    const auto a = farthest(0);
    return {a, farthest(a)};
}

std::vector<Vec2d> conformal(std::span<const Vec3f> positions,
                             std::span<const Triangle> triangles) {
    const auto n = static_cast<int>(positions.size());
    const auto [first, second] = far_pair(positions);
    const double span = (positions[second] - positions[first]).norm();
    // Unknowns: u of every vertex, then v; the pinned ones move to the right side.
    std::vector<double> pinned(static_cast<std::size_t>(2 * n), 0.0);
    pinned[second] = span;
    std::vector<int> column(static_cast<std::size_t>(2 * n), 0);
    int unknowns = 0;
    for (int i = 0; i < 2 * n; ++i) {
        const auto v = static_cast<std::uint32_t>(i % n);
        column[static_cast<std::size_t>(i)] = v == first || v == second ? -1 : unknowns++;
    }
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<int>(2 * triangles.size()));
    int row = 0;
    for (const auto& t : triangles) {
        const auto p = laid_flat(positions, t);
        const double scale = 1.0 / std::sqrt(2.0 * signed_area(p[0], p[1], p[2]));
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2d w = scale * (p[(k + 2) % 3] - p[(k + 1) % 3]);
            const auto add = [&](int r, int variable, double value) {
                const int c = column[static_cast<std::size_t>(variable)];
                if (c >= 0)
                    entries.emplace_back(r, c, value);
                else
                    right[r] -= value * pinned[static_cast<std::size_t>(variable)];
            };
            const int u = static_cast<int>(t[k]), v = u + n;
            add(row, u, w.x());
            add(row, v, -w.y());
            add(row + 1, u, w.y());
            add(row + 1, v, w.x());
        }
        row += 2;
    }
    Sparse matrix(row, unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Solver solver(Sparse(matrix.transpose() * matrix));
    if (solver.info() != Eigen::Success) throw Error("flattening: the piece is no disc");
    const Eigen::VectorXd x = solver.solve(matrix.transpose() * right);
    std::vector<Vec2d> uv(positions.size());
    for (int i = 0; i < 2 * n; ++i) {
        const auto s = static_cast<std::size_t>(i);
        uv[s % positions.size()][i / n] = column[s] < 0 ? pinned[s] : x[column[s]];
    }
    return uv;
}

/// Cotangent weight of the edge opposite corner k.
double cotangent(const std::array<Vec2d, 3>& p, std::size_t k) {
    const Vec2d a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
    return std::clamp(a.dot(b) / (a.x() * b.y() - a.y() * b.x()), 0.05, 20.0);
}

/// The rotation nearest to the 2 x 2 matrix `m`, in closed form.
Eigen::Matrix2d nearest_rotation(const Eigen::Matrix2d& m) {
    const double c = m(0, 0) + m(1, 1), s = m(1, 0) - m(0, 1), length = std::hypot(c, s);
    if (length == 0.0) return Eigen::Matrix2d::Identity();
    Eigen::Matrix2d r;
    r << c / length, -s / length, s / length, c / length;
    return r;
}

void make_rigid(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                int iterations, std::vector<Vec2d>& uv) {
    const auto n = static_cast<int>(positions.size());
    std::vector<std::array<Vec2d, 3>> flat;
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& t : triangles) {
        flat.push_back(laid_flat(positions, t));
        for (std::size_t k = 0; k < 3; ++k) {
            const double w = cotangent(flat.back(), k);
            const auto i = static_cast<int>(t[(k + 1) % 3]), j = static_cast<int>(t[(k + 2) % 3]);
            entries.emplace_back(i, i, w);
            entries.emplace_back(j, j, w);
            entries.emplace_back(i, j, -w);
            entries.emplace_back(j, i, -w);
        }
    }
    entries.emplace_back(0, 0, 1.0); // holds the piece in place
    Sparse matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Solver solver(matrix);
    if (solver.info() != Eigen::Success) throw Error("flattening: the rigid system is singular");
    for (int iteration = 0; iteration < iterations; ++iteration) {
        Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 2);
        right.row(0) += uv[0].transpose();
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            const auto& t = triangles[f];
            Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
            for (std::size_t k = 0; k < 3; ++k) {
                const auto i = (k + 1) % 3, j = (k + 2) % 3;
                covariance += cotangent(flat[f], k) * (uv[t[i]] - uv[t[j]]) *
                              (flat[f][i] - flat[f][j]).transpose();
            }
            const Eigen::Matrix2d rotation = nearest_rotation(covariance);
            for (std::size_t k = 0; k < 3; ++k) {
                const auto i = (k + 1) % 3, j = (k + 2) % 3;
                const Vec2d e = cotangent(flat[f], k) * (rotation * (flat[f][i] - flat[f][j]));
                right.row(static_cast<int>(t[i])) += e.transpose();
                right.row(static_cast<int>(t[j])) -= e.transpose();
            }
        }
        const Eigen::MatrixXd x = solver.solve(right);
        std::vector<Vec2d> next(uv.size());
        for (int v = 0; v < n; ++v)
            next[static_cast<std::size_t>(v)] = x.row(v).transpose();
        if (!all_upright(triangles, next)) return;
        uv.swap(next);
    }
}

} // namespace

std::vector<Vec2f> flatten_disc(std::span<const Vec3f> positions,
                                std::span<const Triangle> triangles,
                                const FlattenOptions& options) {
    const auto report = check_topology(positions, triangles);
    const auto edges = (3 * triangles.size() + report.boundary_edges) / 2;
    const auto euler = static_cast<std::int64_t>(positions.size() + triangles.size()) -
                       static_cast<std::int64_t>(edges);
    if (!report.manifold() || report.components != 1 || euler != 1)
        throw Error("flattening: the piece is no disc (Euler characteristic " +
                    std::to_string(euler) + ", " + std::to_string(report.components) + " pieces) " +
                    report.text());
    std::vector<Vec2d> uv = conformal(positions, triangles);
    if (!all_upright(triangles, uv)) throw Error("flattening turned a triangle over");
    make_rigid(positions, triangles, options.rigid_iterations, uv);
    std::vector<Vec2f> out;
    for (const auto& p : uv)
        out.push_back(p.cast<float>());
    return out;
}

std::array<double, 2> triangle_stretch(const std::array<Vec3f, 3>& surface,
                                       const std::array<Vec2f, 3>& plane) {
    const auto p = laid_flat(surface, {0, 1, 2});
    Eigen::Matrix2d from, to;
    from << p[1] - p[0], p[2] - p[0];
    to << (plane[1] - plane[0]).cast<double>(), (plane[2] - plane[0]).cast<double>();
    const Eigen::Matrix2d m = to * from.inverse();
    const double sum = 0.5 * std::hypot(m(0, 0) + m(1, 1), m(1, 0) - m(0, 1));
    const double difference = 0.5 * std::hypot(m(0, 0) - m(1, 1), m(1, 0) + m(0, 1));
    return {sum + difference, std::abs(sum - difference)};
}

} // namespace toile::geometry
