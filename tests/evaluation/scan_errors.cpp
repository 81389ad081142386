#include "scan_errors.h"

#include "assets/colored_mesh.h"
#include "geometry/nearest_surface.h"
#include "geometry/slice.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace toile::evaluation {

std::vector<double> vertex_areas(const geometry::TriangleMesh& mesh) {
    std::vector<double> out(mesh.positions.size(), 0.0);
    for (const Triangle& t : mesh.triangles) {
        const Vec3f a = mesh.positions[t[1]] - mesh.positions[t[0]],
                    b = mesh.positions[t[2]] - mesh.positions[t[0]];
        for (const std::uint32_t v : t)
            out[v] += static_cast<double>(a.cross(b).norm()) / 6.0;
    }
    return out;
}

Deviation deviation(std::span<const Vec3f> points, const geometry::TriangleMesh& surface,
                    std::span<const double> weights) {
    const geometry::NearestSurface tree(surface.positions, surface.triangles);
    std::vector<std::pair<double, double>> distances; // and weights
    Deviation out;
    double all = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double weight = weights.empty() ? 1.0 : weights[i];
        distances.emplace_back(tree.nearest(points[i]).distance, weight);
        out.mean_m += weight * distances.back().first;
        all += weight;
    }
    if (!(all > 0.0)) return out;
    std::sort(distances.begin(), distances.end());
    out.mean_m /= all;
    out.most_m = distances.back().first;
    double below = 0.0;
    for (const auto& [distance, weight] : distances) {
        below += weight;
        out.p95_m = distance;
        if (below >= 0.95 * all) break;
    }
    return out;
}

Eigen::Isometry3d best_motion(std::span<const Vec3f> points,
                              const geometry::TriangleMesh& surface) {
    constexpr float kReach = 0.03f;
    const geometry::NearestSurface tree(surface.positions, surface.triangles);
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    for (int round = 0; round < 20; ++round) {
        Eigen::Matrix<double, 6, 6> h = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero(), row;
        for (std::size_t i = 0; i < points.size(); i += 7) {
            const Vec3d p = out * points[i].cast<double>();
            const auto near = tree.nearest(p.cast<float>());
            if (near.distance > kReach) continue;
            const Vec3d n = near.normal.cast<double>();
            row << p.cross(n), n;
            h += row * row.transpose();
            g += row * n.dot(p - near.point.cast<double>());
        }
        const Eigen::Matrix<double, 6, 1> step = -h.ldlt().solve(g);
        Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
        const double angle = step.head<3>().norm();
        if (angle > 1e-12)
            move.linear() = Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix();
        move.translation() = step.tail<3>();
        out = move * out;
    }
    return out;
}

double girth_at(const geometry::TriangleMesh& mesh, float height) {
    const auto plane = geometry::Plane::through(Vec3f(0, height, 0), Vec3f::UnitY());
    double out = 0.0;
    for (const auto& loop : geometry::slice(mesh.positions, mesh.triangles, plane))
        if (loop.closed) out = std::max(out, geometry::hull_girth(loop.points, plane));
    return out;
}

geometry::TriangleMesh load_truth(const std::string& name) {
    const std::filesystem::path file = name;
    const bool cache = std::filesystem::is_directory(file);
    return assets::load_colored_mesh(cache ? file / "surfaces.glb" : file).mesh;
}

void compare(const geometry::TriangleMesh& scan, const geometry::TriangleMesh& truth,
             std::span<const float> heights) {
    const auto print = [](const char* what, const Deviation& d) {
        std::printf("  %-26s mean %5.2f  95 %% %5.2f  most %6.2f mm\n", what, 1e3 * d.mean_m,
                    1e3 * d.p95_m, 1e3 * d.most_m);
    };
    const std::vector<double> areas = vertex_areas(scan);
    print("as it stands", deviation(scan.positions, truth, areas));
    const Eigen::Isometry3d move = best_motion(scan.positions, truth);
    geometry::TriangleMesh laid = scan;
    for (Vec3f& p : laid.positions)
        p = (move * p.cast<double>()).cast<float>();
    print("laid on the truth", deviation(laid.positions, truth, areas));
    print("truth to scan", deviation(truth.positions, laid, vertex_areas(truth)));
    for (const float h : heights)
        std::printf("  girth at %.2f m: %6.1f mm, true %6.1f, %+.1f\n", static_cast<double>(h),
                    1e3 * girth_at(laid, h), 1e3 * girth_at(truth, h),
                    1e3 * (girth_at(laid, h) - girth_at(truth, h)));
}

} // namespace toile::evaluation
