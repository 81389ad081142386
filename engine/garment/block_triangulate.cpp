#include "garment/block_triangulate.h"

#include "core/error.h"
#include "core/random.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <map>
#include <utility>

namespace toile::garment::block {
namespace {

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

double signed_area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return 0.5 * cross(b - a, c - a);
}

bool inside_polygon(const std::span<const Vec2d> polygon, const Vec2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2d& a = polygon[i];
        const Vec2d& b = polygon[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
            inside = !inside;
        }
    }
    return inside;
}

double distance_to_polygon(const std::span<const Vec2d> polygon, const Vec2d& p) {
    double best = 1e30;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2d along = polygon[i] - polygon[j];
        const double t = std::clamp((p - polygon[j]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        best = std::min(best, (polygon[j] + t * along - p).norm());
    }
    return best;
}

// Positive when p lies inside the circle through a, b, c (counter-clockwise).
double in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& p) {
    const Vec2d d = a - p;
    const Vec2d e = b - p;
    const Vec2d f = c - p;
    return d.squaredNorm() * cross(e, f) - e.squaredNorm() * cross(d, f) +
           f.squaredNorm() * cross(d, e);
}

// Bowyer and Watson's insertion; quadratic, for at most a few thousand points.
std::vector<Triangle> delaunay(const std::vector<Vec2d>& input) {
    // A hair's breadth of noise decides between equally good triangles of points on one circle.
    std::vector<Vec2d> points = input;
    Random random(11);
    for (Vec2d& p : points) {
        p += Vec2d(random.uniform(-1e-7, 1e-7), random.uniform(-1e-7, 1e-7));
    }
    const auto n = static_cast<std::uint32_t>(points.size());
    points.emplace_back(-50.0, -40.0);
    points.emplace_back(50.0, -40.0);
    points.emplace_back(0.0, 60.0);
    std::vector<Triangle> triangles = {{n, n + 1, n + 2}};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::uint32_t i = 0; i < n; ++i) {
        edges.clear();
        std::size_t kept = 0;
        for (const Triangle& t : triangles) {
            if (in_circle(points[t[0]], points[t[1]], points[t[2]], points[i]) > 0.0) {
                edges.insert(edges.end(), {{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}});
            } else {
                triangles[kept++] = t;
            }
        }
        triangles.resize(kept);
        for (const auto& [a, b] : edges) {
            if (std::find(edges.begin(), edges.end(), std::pair{b, a}) == edges.end()) {
                triangles.push_back({a, b, i});
            }
        }
        if (triangles.size() > 2 * static_cast<std::size_t>(i) + 3) {
            throw Error("the outline touches or crosses itself");
        }
    }
    std::erase_if(triangles,
                  [n](const Triangle& t) { return t[0] >= n || t[1] >= n || t[2] >= n; });
    return triangles;
}

// Delaunay triangles inside the outline, which must be among their edges.
std::vector<Triangle> fill(const std::span<const Vec2d> outline, const std::vector<Vec2d>& points,
                           const double edge_m) {
    std::vector<Triangle> triangles = delaunay(points);
    std::erase_if(triangles, [&](const Triangle& t) {
        const Vec2d centre = (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0;
        return signed_area(points[t[0]], points[t[1]], points[t[2]]) < 1e-6 * edge_m * edge_m ||
               !inside_polygon(outline, centre);
    });
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

void smooth(const std::span<const Triangle> triangles, const std::size_t border_count,
            std::vector<Vec2d>& points) {
    std::vector<Vec2d> sum(points.size(), Vec2d::Zero());
    std::vector<double> weight(points.size(), 0.0);
    for (const Triangle& t : triangles) {
        const double area = signed_area(points[t[0]], points[t[1]], points[t[2]]);
        const Vec2d centre = (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0;
        for (const std::uint32_t v : t) {
            sum[v] += area * centre;
            weight[v] += area;
        }
    }
    for (std::size_t v = border_count; v < points.size(); ++v) {
        if (weight[v] > 0.0) {
            points[v] = sum[v] / weight[v];
        }
    }
}

void check_outline(const std::span<const Triangle> triangles, const std::size_t border_count) {
    std::vector<bool> found(border_count, false);
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::size_t a = t[k];
            if (a < border_count && t[(k + 1) % 3] == (a + 1) % border_count) {
                found[a] = true;
            }
        }
    }
    if (std::find(found.begin(), found.end(), false) != found.end()) {
        throw Error("the outline is too crooked for its edge length: use a shorter edge");
    }
}

} // namespace

FlatMesh triangulate(const std::span<const Vec2d> outline, const double edge_m) {
    FlatMesh mesh;
    mesh.points.assign(outline.begin(), outline.end());
    mesh.border_count = outline.size();
    Vec2d low = outline.front();
    Vec2d high = outline.front();
    for (const Vec2d& p : outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    // The lattice; a little noise keeps four points off one circle.
    Random random(7);
    const double row = edge_m * 0.5 * std::sqrt(3.0);
    int j = 0;
    for (double y = low.y() + 0.5 * row; y < high.y(); y += row, ++j) {
        for (double x = low.x() + (j % 2 == 0 ? 0.25 : 0.75) * edge_m; x < high.x(); x += edge_m) {
            const Vec2d p(x + random.uniform(-1.0, 1.0) * 1e-3 * edge_m,
                          y + random.uniform(-1.0, 1.0) * 1e-3 * edge_m);
            if (inside_polygon(outline, p) && distance_to_polygon(outline, p) > 0.6 * edge_m) {
                mesh.points.push_back(p);
            }
        }
    }
    constexpr int kRounds = 12;
    for (int round = 0; round < kRounds; ++round) {
        mesh.triangles = fill(outline, mesh.points, edge_m);
        smooth(mesh.triangles, mesh.border_count, mesh.points);
    }
    mesh.triangles = fill(outline, mesh.points, edge_m);
    check_outline(mesh.triangles, mesh.border_count);
    return mesh;
}

std::vector<Vec3d> harmonic(const FlatMesh& mesh, const std::span<const Vec3d> border) {
    const std::size_t n = mesh.points.size();
    const std::size_t nb = mesh.border_count;
    std::vector<Vec3d> out(border.begin(), border.end());
    out.resize(n, Vec3d::Zero());
    if (n == nb) {
        return out;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> weights;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k];
            const std::uint32_t b = t[(k + 1) % 3];
            const std::uint32_t c = t[(k + 2) % 3];
            const Vec2d u = mesh.points[a] - mesh.points[c];
            const Vec2d v = mesh.points[b] - mesh.points[c];
            weights[std::minmax(a, b)] += 0.5 * u.dot(v) / cross(u, v);
        }
    }
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n - nb), 3);
    const auto add = [&](const std::uint32_t a, const std::uint32_t b, const double w) {
        if (a < nb) {
            return;
        }
        const auto row = static_cast<int>(a - nb);
        entries.emplace_back(row, row, w);
        if (b < nb) {
            right.row(row) += w * border[b].transpose();
        } else {
            entries.emplace_back(row, static_cast<int>(b - nb), -w);
        }
    };
    for (const auto& [edge, w] : weights) {
        add(edge.first, edge.second, w);
        add(edge.second, edge.first, w);
    }
    Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(n - nb),
                                       static_cast<Eigen::Index>(n - nb));
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    const Eigen::MatrixXd inner = solver.solve(right);
    for (std::size_t v = nb; v < n; ++v) {
        out[v] = inner.row(static_cast<Eigen::Index>(v - nb)).transpose();
    }
    return out;
}

} // namespace toile::garment::block
