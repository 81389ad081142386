#include "body/spectral_parts.h"

#include "core/error.h"
#include "geometry/point_tree.h"
#include "geometry/spectral.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace toile::body {
namespace {

constexpr double kAlike = 0.12;      // eigenvalues so close mix: their turn is taken from height
constexpr double kLeastHeight = 0.2; // metres: covariance of "up" with height
constexpr double kLeastLimbs = 0.5;  // of legs' and arms' mean square times "up"

using geometry::Spectrum;

double moment(const Spectrum& s, const Eigen::VectorXd& a, const Eigen::VectorXd& b,
              const Eigen::VectorXd& c) {
    return (s.mass.array() * a.array() * b.array() * c.array()).sum();
}

Eigen::Vector3d with_coordinate(const Spectrum& s, const geometry::TriangleMesh& mesh, int axis) {
    Eigen::VectorXd x(s.mass.size());
    for (Eigen::Index v = 0; v < x.size(); ++v)
        x[v] = static_cast<double>(mesh.positions[static_cast<std::size_t>(v)][axis]);
    x.array() -= s.mass.dot(x);
    return s.vectors.transpose() * s.mass.cwiseProduct(x);
}

[[noreturn]] void refuse(const char* what) {
    throw Error(std::string("the surface does not come apart into a person's parts: ") + what +
                "; it must be one upright person (+Y up), arms and legs apart from each other");
}

/// Turns eigenvectors of nearly the same value so that one goes with height and the other not.
void untangle(Spectrum& s, const geometry::TriangleMesh& mesh, int up) {
    const Eigen::Vector3d heights = with_coordinate(s, mesh, 1);
    for (int k = 0; k < 3; ++k) {
        if (k == up) continue;
        const double apart = std::abs(s.values[k] - s.values[up]) / s.values[up];
        if (apart > kAlike) continue;
        const double turn = (1.0 - apart / kAlike) * std::atan(heights[k] / heights[up]);
        const Eigen::VectorXd a = s.vectors.col(up), b = s.vectors.col(k);
        s.vectors.col(up) = std::cos(turn) * a + std::sin(turn) * b;
        s.vectors.col(k) = std::cos(turn) * b - std::sin(turn) * a;
    }
}

/// Up, legs, arms: a basis that does not hang on the solver's.
SpectralParts canonical_axes(Spectrum& s, const geometry::TriangleMesh& mesh) {
    int up = 0;
    with_coordinate(s, mesh, 1).cwiseAbs().maxCoeff(&up);
    untangle(s, mesh, up);
    SpectralParts out;
    out.axes.resize(s.vectors.rows(), 3);
    const double rise = with_coordinate(s, mesh, 1)[up];
    if (std::abs(rise) < kLeastHeight) refuse("nothing goes with height");
    out.axes.col(0) = (rise < 0.0 ? -1.0 : 1.0) * s.vectors.col(up);
    // Within the plane of the others: the directions in which they are large low, and high.
    const int i = up == 0 ? 1 : 0, j = up == 2 ? 1 : 2;
    const Eigen::VectorXd a = s.vectors.col(i), b = s.vectors.col(j), u = out.axes.col(0);
    Eigen::Matrix2d high;
    high << moment(s, a, a, u), moment(s, a, b, u), moment(s, a, b, u), moment(s, b, b, u);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(high);
    if (solver.eigenvalues()[0] > -kLeastLimbs) refuse("no two legs");
    if (solver.eigenvalues()[1] < kLeastLimbs) refuse("no two arms");
    for (int k = 0; k < 2; ++k) {
        const Eigen::Vector2d d = solver.eigenvectors().col(k);
        out.axes.col(1 + k) = d[0] * a + d[1] * b;
    }
    out.values = {s.values[up], s.values[i], s.values[j]};
    return out;
}

/// Both rise to the left: by where the limbs that they belong to are.
void sign_limbs(SpectralParts& out, const Spectrum& s, const geometry::TriangleMesh& mesh) {
    for (int k = 1; k < 3; ++k) {
        double sum = 0.0;
        for (Eigen::Index v = 0; v < s.mass.size(); ++v) {
            const bool limb = k == 1 ? out.axes(v, 0) < -0.3 : out.axes(v, 0) > 0.3;
            if (limb)
                sum += s.mass[v] * out.axes(v, k) *
                       static_cast<double>(mesh.positions[static_cast<std::size_t>(v)].x());
        }
        if (sum < 0.0) out.axes.col(k) *= -1.0;
    }
}

/// The largest piece; rows of `of` that named others name the nearest vertex of it.
geometry::TriangleMesh main_piece(const geometry::TriangleMesh& mesh,
                                  std::vector<std::uint32_t>& of) {
    std::vector<std::uint32_t> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<std::size_t> sizes(parent.size(), 0);
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 1; k < 3; ++k) {
            const std::uint32_t a = root(t[0]), b = root(t[k]);
            parent[std::max(a, b)] = std::min(a, b);
        }
    for (const Triangle& t : mesh.triangles)
        ++sizes[root(t[0])];
    const auto main =
        static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    geometry::TriangleMesh out;
    std::vector<std::uint32_t> place(parent.size());
    for (std::uint32_t v = 0; v < place.size(); ++v) {
        if (root(v) != main) continue;
        place[v] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(mesh.positions[v]);
    }
    const geometry::PointTree tree(out.positions);
    for (std::uint32_t v = 0; v < place.size(); ++v)
        if (root(v) != main) place[v] = tree.nearest(mesh.positions[v]).index;
    for (const Triangle& t : mesh.triangles)
        if (root(t[0]) == main) out.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    for (std::uint32_t& v : of)
        v = place[v];
    return out;
}

constexpr std::size_t kLarge = 30'000; // vertices: more are taken together first

/// A coarser surface for the eigenvectors alone: vertices of one cell that face alike are one, so
/// that surfaces which touch stay apart. `of` (nv) gets each vertex's place in it.
geometry::TriangleMesh coarse(const geometry::TriangleMesh& mesh, std::vector<std::uint32_t>& of) {
    const double edge = std::sqrt(2.3 * geometry::surface_area(mesh) / (0.6 * kLarge));
    std::vector<Vec3f> normals(mesh.positions.size());
    geometry::vertex_normals(mesh.positions, mesh.triangles, normals);
    std::map<std::array<int, 4>, std::uint32_t> cells;
    geometry::TriangleMesh out;
    std::vector<float> counts;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        std::array<int, 4> key{};
        for (int k = 0; k < 3; ++k)
            key[static_cast<std::size_t>(k)] =
                static_cast<int>(std::floor(static_cast<double>(mesh.positions[v][k]) / edge));
        Eigen::Index side = 0;
        normals[v].cwiseAbs().maxCoeff(&side);
        key[3] = 2 * static_cast<int>(side) + (normals[v][side] > 0.0f ? 1 : 0);
        const auto [at, added] =
            cells.try_emplace(key, static_cast<std::uint32_t>(out.positions.size()));
        if (added) {
            out.positions.emplace_back(Vec3f::Zero());
            counts.push_back(0.0f);
        }
        of.push_back(at->second);
        out.positions[at->second] += mesh.positions[v];
        counts[at->second] += 1.0f;
    }
    for (std::size_t v = 0; v < counts.size(); ++v)
        out.positions[v] /= counts[v];
    for (const Triangle& t : mesh.triangles) {
        const Triangle c = {of[t[0]], of[t[1]], of[t[2]]};
        if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) out.triangles.push_back(c);
    }
    return main_piece(out, of);
}

} // namespace

SpectralParts spectral_parts(const geometry::TriangleMesh& mesh) {
    if (mesh.positions.size() > kLarge) {
        std::vector<std::uint32_t> of;
        const SpectralParts few = spectral_parts(coarse(mesh, of));
        SpectralParts out = few;
        out.of.clear();
        out.axes.resize(static_cast<Eigen::Index>(of.size()), 3);
        for (std::size_t v = 0; v < of.size(); ++v) {
            out.of.push_back(few.of[of[v]]);
            out.axes.row(static_cast<Eigen::Index>(v)) = few.axes.row(of[v]);
        }
        return out;
    }
    Spectrum s = geometry::laplace_beltrami(mesh, 3);
    SpectralParts out = canonical_axes(s, mesh);
    sign_limbs(out, s, mesh);
    // Where the parts of a standing adult are; rows in SpectralPart's order.
    Eigen::MatrixXd first(10, 3);
    first << 1.0, 0.0, 0.0, /**/ 0.0, 0.0, 0.0, /**/ 1.0, 0.0, 1.0, /**/ 1.5, 0.0, 2.6, /**/ //
        1.0, 0.0, -1.0, /**/ 1.5, 0.0, -2.6, /**/ -0.7, 0.7, 0.0, /**/ -1.4, 2.1, 0.0, /**/  //
        -0.7, -0.7, 0.0, /**/ -1.4, -2.1, 0.0;
    const geometry::Clusters clusters = geometry::k_means(out.axes, s.mass, first);
    out.rounds = clusters.rounds;
    out.of.reserve(clusters.of.size());
    for (const std::uint32_t c : clusters.of)
        out.of.push_back(static_cast<SpectralPart>(c + 1));
    return out;
}

double overlap(const std::vector<SpectralPart>& a, const std::vector<SpectralPart>& b,
               SpectralPart part, const Eigen::VectorXd& areas) {
    double both = 0.0, either = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) {
        const bool in_a = a[v] == part, in_b = b.at(v) == part;
        const double area = areas[static_cast<Eigen::Index>(v)];
        if (in_a && in_b) both += area;
        if (in_a || in_b) either += area;
    }
    return either > 0.0 ? both / either : 0.0;
}

} // namespace toile::body
