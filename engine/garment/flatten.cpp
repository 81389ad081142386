#include "garment/flatten.h"

#include "core/error.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace toile::garment {
namespace {

using Vec2d = Eigen::Vector2d;
using Mat2d = Eigen::Matrix2d;
using Flat = std::array<Vec2d, 3>; ///< one triangle laid flat

constexpr int kRounds = 25;
constexpr double kMostStrain = 0.05;
constexpr double kGap = 0.03; ///< metres between charts

/// A triangle with its true lengths, first corner at the origin, first side along x.
Flat isometric(std::span<const Vec3f> positions, const Triangle& t) {
    const Vec3d a = positions[t[0]].cast<double>();
    const Vec3d e = positions[t[1]].cast<double>() - a;
    const Vec3d f = positions[t[2]].cast<double>() - a;
    const double length = e.norm();
    return {Vec2d::Zero(), Vec2d(length, 0.0),
            Vec2d(e.dot(f) / length, e.cross(f).norm() / length)};
}

double signed_area(const Flat& f) {
    const Vec2d a = f[1] - f[0];
    const Vec2d b = f[2] - f[0];
    return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

/// The linear map from the true triangle to the one laid flat.
Mat2d deformation(const Flat& truth, const Flat& flat) {
    Mat2d from;
    Mat2d to;
    from << truth[1] - truth[0], truth[2] - truth[0];
    to << flat[1] - flat[0], flat[2] - flat[0];
    return to * from.inverse();
}

Mat2d nearest_rotation(const Mat2d& m) {
    const double c = m(0, 0) + m(1, 1);
    const double s = m(1, 0) - m(0, 1);
    const double length = std::hypot(c, s);
    if (length < 1e-15) return Mat2d::Identity();
    Mat2d r;
    r << c / length, -s / length, s / length, c / length;
    return r;
}

/// Largest departure of a singular value from 1.
double strain(const Mat2d& m) {
    const Eigen::Vector2d s = Eigen::JacobiSVD<Mat2d>(m).singularValues();
    const double most = std::max(std::abs(s[0] - 1.0), std::abs(s[1] - 1.0));
    return m.determinant() > 0.0 ? most : std::max(most, 1.0);
}

/// Neighbour of each triangle across side k, or -1. The mesh is manifold.
std::vector<std::array<int, 3>> neighbours_of(const geometry::TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> open;
    std::vector<std::array<int, 3>> out(mesh.triangles.size(), {-1, -1, -1});
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[i][k];
            const std::uint32_t b = mesh.triangles[i][(k + 1) % 3];
            open[{a, b}] = {static_cast<int>(i), static_cast<int>(k)};
            const auto other = open.find({b, a});
            if (other == open.end()) continue;
            out[i][k] = other->second.first;
            out[static_cast<std::size_t>(other->second.first)]
               [static_cast<std::size_t>(other->second.second)] = static_cast<int>(i);
        }
    return out;
}

bool seam_between(const geometry::TriangleMesh& mesh, std::span<const Vec2f> uv, std::size_t a,
                  std::size_t b) {
    constexpr float kSame = 1e-5f;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (mesh.triangles[a][i] == mesh.triangles[b][j] &&
                (uv[3 * a + i] - uv[3 * b + j]).cwiseAbs().maxCoeff() > kSame)
                return true;
    return false;
}

Vec3d normal_of(const geometry::TriangleMesh& mesh, std::size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3d a = mesh.positions[t[0]].cast<double>();
    return (mesh.positions[t[1]].cast<double>() - a)
        .cross(mesh.positions[t[2]].cast<double>() - a)
        .normalized();
}

using Chart = std::vector<std::uint32_t>; ///< triangles

/// Grows charts from the lowest triangle on; `join(chart's seed, from, to)` says where to go on.
template <typename Join>
std::vector<Chart> grow_charts(const std::vector<std::array<int, 3>>& neighbours,
                               const std::vector<bool>& wanted, Join&& join) {
    std::vector<bool> taken(neighbours.size(), false);
    std::vector<Chart> charts;
    for (std::uint32_t seed = 0; seed < neighbours.size(); ++seed) {
        if (taken[seed] || !wanted[seed]) continue;
        Chart chart = {seed};
        taken[seed] = true;
        for (std::size_t at = 0; at < chart.size(); ++at)
            for (const int other : neighbours[chart[at]]) {
                if (other < 0) continue;
                const auto next = static_cast<std::uint32_t>(other);
                if (taken[next] || !wanted[next] || !join(seed, chart[at], next)) continue;
                taken[next] = true;
                chart.push_back(next);
            }
        std::sort(chart.begin(), chart.end());
        charts.push_back(std::move(chart));
    }
    return charts;
}

/// A chart's own vertices, and where they lie at first.
struct ChartMesh {
    std::vector<std::array<int, 3>> corners; ///< (triangles)
    std::vector<Flat> truth;                 ///< (triangles)
    Eigen::MatrixX2d flat;                   ///< (vertices)
};

/// Vertices of a chart by welded vertex and texture coordinates, where these are; no truth.
ChartMesh chart_of(const geometry::TriangleMesh& mesh, const Chart& chart,
                   std::span<const Vec2f> uv) {
    ChartMesh out;
    std::map<std::tuple<std::uint32_t, float, float>, int> index;
    std::vector<Vec2d> flat;
    for (const std::uint32_t t : chart) {
        std::array<int, 3>& corners = out.corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2f& m = uv[3 * t + k];
            const auto [at, added] = index.try_emplace({mesh.triangles[t][k], m.x(), m.y()},
                                                       static_cast<int>(flat.size()));
            if (added) flat.emplace_back(m.x(), m.y());
            corners[k] = at->second;
        }
    }
    out.flat.resize(static_cast<Eigen::Index>(flat.size()), 2);
    for (std::size_t i = 0; i < flat.size(); ++i)
        out.flat.row(static_cast<Eigen::Index>(i)) = flat[i].transpose();
    return out;
}

Flat flat_triangle(const ChartMesh& chart, std::size_t i) {
    Flat out;
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = chart.flat.row(chart.corners[i][k]).transpose();
    return out;
}

/// Laid out as the texture is, in metres.
ChartMesh chart_from_texture(const geometry::TriangleMesh& mesh, const Chart& chart,
                             std::span<const Vec2f> uv) {
    ChartMesh out = chart_of(mesh, chart, uv);
    double area = 0.0;
    double flat_area = 0.0;
    for (std::size_t i = 0; i < chart.size(); ++i) {
        out.truth.push_back(isometric(mesh.positions, mesh.triangles[chart[i]]));
        area += signed_area(out.truth.back());
        flat_area += signed_area(flat_triangle(out, i));
    }
    // A texture may be mirrored (image rows run down): u turns over.
    const double scale = std::sqrt(area / std::max(std::abs(flat_area), 1e-12));
    out.flat.col(0) *= flat_area < 0.0 ? -scale : scale;
    out.flat.col(1) *= scale;
    return out;
}

/// Vertices of a chart by welded vertex; laid out by looking at it along its mean normal.
ChartMesh chart_from_projection(const geometry::TriangleMesh& mesh, const Chart& chart) {
    ChartMesh out;
    std::map<std::uint32_t, int> index;
    std::vector<Vec3d> points;
    Vec3d normal = Vec3d::Zero();
    for (const std::uint32_t t : chart) {
        std::array<int, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [at, added] =
                index.try_emplace(mesh.triangles[t][k], static_cast<int>(points.size()));
            if (added) points.push_back(mesh.positions[mesh.triangles[t][k]].cast<double>());
            corners[k] = at->second;
        }
        out.corners.push_back(corners);
        out.truth.push_back(isometric(mesh.positions, mesh.triangles[t]));
        normal += signed_area(out.truth.back()) * normal_of(mesh, t);
    }
    normal = normal.norm() > 1e-12 ? Vec3d(normal.normalized()) : Vec3d(Vec3d::UnitZ());
    const Vec3d up = std::abs(normal.y()) < 0.9 ? Vec3d::UnitY() : Vec3d(-Vec3d::UnitZ());
    const Vec3d u = up.cross(normal).normalized();
    const Vec3d v = normal.cross(u);
    out.flat.resize(static_cast<Eigen::Index>(points.size()), 2);
    for (std::size_t i = 0; i < points.size(); ++i)
        out.flat.row(static_cast<Eigen::Index>(i)) << points[i].dot(u), points[i].dot(v);
    return out;
}

/// Local step: the rotation of each triangle; global step: vertices that fit them (Liu et al.
/// 2008).
void lay_flat(ChartMesh& chart) {
    const Eigen::Index n = chart.flat.rows();
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<std::array<double, 3>> cotangents(chart.corners.size());
    for (std::size_t i = 0; i < chart.corners.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Flat& f = chart.truth[i];
            const Vec2d a = f[k] - f[(k + 2) % 3];
            const Vec2d b = f[(k + 1) % 3] - f[(k + 2) % 3];
            const double cross = std::abs(a.x() * b.y() - a.y() * b.x());
            const double w = std::clamp(a.dot(b) / std::max(cross, 1e-14), 0.02, 20.0);
            cotangents[i][k] = w;
            const int p = chart.corners[i][k];
            const int q = chart.corners[i][(k + 1) % 3];
            entries.emplace_back(p, p, w);
            entries.emplace_back(q, q, w);
            entries.emplace_back(p, q, -w);
            entries.emplace_back(q, p, -w);
        }
    for (Eigen::Index i = 0; i < n; ++i)
        entries.emplace_back(i, i, 1e-9); // fixes the place of each piece, not its shape
    Eigen::SparseMatrix<double> system(n, n);
    system.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
    if (solver.info() != Eigen::Success) throw Error("a chart of the mesh cannot be laid flat");
    for (int round = 0; round < kRounds; ++round) {
        Eigen::MatrixX2d right = 1e-9 * chart.flat;
        for (std::size_t i = 0; i < chart.corners.size(); ++i) {
            const Flat& truth = chart.truth[i];
            const Mat2d r = nearest_rotation(deformation(truth, flat_triangle(chart, i)));
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2d side = cotangents[i][k] * (r * (truth[k] - truth[(k + 1) % 3]));
                right.row(chart.corners[i][k]) += side.transpose();
                right.row(chart.corners[i][(k + 1) % 3]) -= side.transpose();
            }
        }
        chart.flat = solver.solve(right);
    }
}

/// Turns the chart so that height over ground grows along +v (the warp hangs down).
void turn_warp_up(const geometry::TriangleMesh& mesh, const Chart& triangles, ChartMesh& chart) {
    Vec2d up = Vec2d::Zero();
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Flat f = flat_triangle(chart, i);
        Mat2d sides;
        sides << (f[1] - f[0]).transpose(), (f[2] - f[0]).transpose();
        if (std::abs(sides.determinant()) < 1e-14) continue;
        const Triangle& t = mesh.triangles[triangles[i]];
        const Vec2d rise(mesh.positions[t[1]].y() - mesh.positions[t[0]].y(),
                         mesh.positions[t[2]].y() - mesh.positions[t[0]].y());
        up += signed_area(chart.truth[i]) * (sides.inverse() * rise);
    }
    if (up.norm() < 1e-9) return;
    up.normalize();
    Mat2d turn;
    turn << up.y(), -up.x(), up.x(), up.y();
    chart.flat = (chart.flat * turn.transpose()).eval();
}

/// Where the charts that are done end, along u.
struct Shelf {
    double u = 0.0;
};

/// Writes a chart's corners; triangles beyond the strain limit keep their true shape, turned alike.
void write_chart(const Chart& triangles, const ChartMesh& chart, Shelf& shelf, Flattening& out,
                 double& area, double& strain_sum) {
    const Vec2d low = chart.flat.colwise().minCoeff().transpose();
    const double width = chart.flat.col(0).maxCoeff() - low.x();
    const Vec2d shift = Vec2d(shelf.u, 0.0) - low;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Flat f = flat_triangle(chart, i);
        const Mat2d map = deformation(chart.truth[i], f);
        const double here = strain(map);
        if (here > kMostStrain) {
            const Mat2d r = nearest_rotation(map);
            const Vec2d centre = (f[0] + f[1] + f[2]) / 3.0;
            const Vec2d middle = (chart.truth[i][0] + chart.truth[i][1] + chart.truth[i][2]) / 3.0;
            for (std::size_t k = 0; k < 3; ++k)
                f[k] = centre + r * (chart.truth[i][k] - middle);
            ++out.loose_triangles;
        } else {
            strain_sum += here * signed_area(chart.truth[i]);
        }
        area += signed_area(chart.truth[i]);
        for (std::size_t k = 0; k < 3; ++k)
            out.coords[3 * triangles[i] + k] = (f[k] + shift).cast<float>();
    }
    shelf.u += width + kGap;
}

/// How each flat triangle of a chart is stretched when its carried one is against the old one:
/// symmetric, in the frame of the flat pattern.
std::vector<Mat2d> stretches(const ChartMesh& chart, const Chart& triangles,
                             const geometry::TriangleMesh& mesh, std::span<const Vec3f> carried) {
    constexpr double kLeastArea = 1e-12; // m^2
    std::vector<Mat2d> out;
    out.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[triangles[i]];
        const Flat flat = flat_triangle(chart, i);
        const Flat from = isometric(mesh.positions, t);
        if (!(std::abs(signed_area(flat)) >= kLeastArea && signed_area(from) >= kLeastArea))
            throw Error("a triangle of the garment has no area");
        const Mat2d cloth = deformation(from, flat);
        const Mat2d map = cloth * deformation(from, isometric(carried, t)) * cloth.inverse();
        out.push_back(nearest_rotation(map).transpose() * map);
        out.back() = 0.5 * (out.back() + out.back().transpose()).eval();
    }
    return out;
}

/// Evens stretches out over a hand's breadth: nobody cuts cloth by every fold that it had.
void even_out(const Chart& triangles, const std::vector<std::array<int, 3>>& neighbours,
              std::vector<Mat2d>& stretch) {
    constexpr int kSteps = 60;
    std::map<std::uint32_t, std::size_t> place;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        place[triangles[i]] = i;
    std::vector<std::vector<std::size_t>> beside(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (const int other : neighbours[triangles[i]]) {
            const auto at = other < 0 ? place.end() : place.find(static_cast<std::uint32_t>(other));
            if (at != place.end()) beside[i].push_back(at->second);
        }
    std::vector<Mat2d> next = stretch;
    for (int step = 0; step < kSteps; ++step) {
        for (std::size_t i = 0; i < stretch.size(); ++i) {
            Mat2d sum = stretch[i];
            for (const std::size_t j : beside[i])
                sum += stretch[j];
            next[i] = sum / static_cast<double>(1 + beside[i].size());
        }
        stretch.swap(next);
    }
}

/// Undoes the turn and the shift that laying flat anew gave a chart as a whole.
void hold_grain(const ChartMesh& before, ChartMesh& after) {
    Mat2d sum = Mat2d::Zero();
    Vec2d centre_before = Vec2d::Zero();
    Vec2d centre_after = Vec2d::Zero();
    double area = 0.0;
    for (std::size_t i = 0; i < after.corners.size(); ++i) {
        const Flat a = flat_triangle(before, i);
        const Flat b = flat_triangle(after, i);
        const double weight = std::abs(signed_area(a));
        sum += weight * nearest_rotation(deformation(a, b));
        centre_before += weight / 3.0 * (a[0] + a[1] + a[2]);
        centre_after += weight / 3.0 * (b[0] + b[1] + b[2]);
        area += weight;
    }
    const Mat2d back = nearest_rotation(sum).transpose();
    for (Eigen::Index i = 0; i < after.flat.rows(); ++i) {
        const Vec2d p = after.flat.row(i).transpose() - centre_after / area;
        after.flat.row(i) = (centre_before / area + back * p).transpose();
    }
}

} // namespace

std::vector<Vec2f> flatten_carried(const geometry::TriangleMesh& mesh,
                                   std::span<const Vec2f> coords, std::span<const Vec3f> carried) {
    std::vector<Vec2f> out(coords.begin(), coords.end());
    const std::vector<bool> all(mesh.triangles.size(), true);
    const auto neighbours = neighbours_of(mesh);
    const auto charts = grow_charts(neighbours, all, [&](auto, std::uint32_t a, std::uint32_t b) {
        return !seam_between(mesh, coords, a, b);
    });
    for (const Chart& triangles : charts) {
        const ChartMesh before = chart_of(mesh, triangles, coords);
        ChartMesh after = before;
        std::vector<Mat2d> stretch = stretches(before, triangles, mesh, carried);
        even_out(triangles, neighbours, stretch);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const Flat flat = flat_triangle(before, i);
            after.truth.push_back({Vec2d::Zero(), stretch[i] * (flat[1] - flat[0]),
                                   stretch[i] * (flat[2] - flat[0])});
        }
        lay_flat(after);
        hold_grain(before, after);
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                out[3 * triangles[i] + k] =
                    after.flat.row(after.corners[i][k]).transpose().cast<float>();
    }
    return out;
}

Flattening flatten(const geometry::TriangleMesh& mesh, std::span<const Vec2f> texcoords) {
    Flattening out;
    out.coords.assign(3 * mesh.triangles.size(), Vec2f::Zero());
    const auto neighbours = neighbours_of(mesh);
    const std::vector<bool> all(mesh.triangles.size(), true);
    const bool textured = texcoords.size() == out.coords.size();
    double area = 0.0;
    double strain_sum = 0.0;
    Shelf shelf;
    const auto finish = [&](const Chart& triangles, ChartMesh& chart) {
        turn_warp_up(mesh, triangles, chart);
        write_chart(triangles, chart, shelf, out, area, strain_sum);
        ++out.charts;
    };
    std::vector<bool> left = all;
    if (textured) {
        const auto charts =
            grow_charts(neighbours, all, [&](auto, std::uint32_t a, std::uint32_t b) {
                return !seam_between(mesh, texcoords, a, b);
            });
        for (const Chart& triangles : charts) {
            ChartMesh chart = chart_from_texture(mesh, triangles, texcoords);
            lay_flat(chart);
            std::size_t bad = 0;
            for (std::size_t i = 0; i < triangles.size(); ++i)
                if (strain(deformation(chart.truth[i], flat_triangle(chart, i))) > 4 * kMostStrain)
                    ++bad;
            if (4 * bad > triangles.size()) continue; // folded: grow other charts below
            finish(triangles, chart);
            for (const std::uint32_t t : triangles)
                left[t] = false;
        }
    }
    const auto charts =
        grow_charts(neighbours, left, [&](std::uint32_t seed, std::uint32_t, std::uint32_t next) {
            return normal_of(mesh, seed).dot(normal_of(mesh, next)) > 0.4;
        });
    for (const Chart& triangles : charts) {
        ChartMesh chart = chart_from_projection(mesh, triangles);
        lay_flat(chart);
        finish(triangles, chart);
    }
    out.mean_strain = area > 0.0 ? strain_sum / area : 0.0;
    return out;
}

} // namespace toile::garment
