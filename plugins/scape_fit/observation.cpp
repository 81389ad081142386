#include "scape_fit/observation.h"

#include "core/error.h"
#include "core/random.h"
#include "geometry/point_tree.h"
#include "scape_fit/contour.h"
#include "scape_fit/skin_tone.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <numeric>

namespace toile::scape_fit {
namespace {

constexpr std::size_t kNormalNeighbours = 16;
constexpr float kRim = 0.025f; // metres beside a border

/// Every n-th of a shuffled order would do; a stride through the given order keeps scans' own
/// evenness and is the same each time.
std::vector<std::size_t> spread(std::size_t size, std::size_t count) {
    std::vector<std::size_t> out;
    const double step = std::max(1.0, static_cast<double>(size) / static_cast<double>(count));
    for (double at = 0.0; at < static_cast<double>(size); at += step)
        out.push_back(static_cast<std::size_t>(at));
    return out;
}

Vec3f plane_normal(std::span<const Vec3f> points,
                   std::span<const geometry::PointTree::Neighbour> near) {
    Vec3f mean = Vec3f::Zero();
    for (const auto& n : near)
        mean += points[n.index];
    mean /= static_cast<float>(near.size());
    Mat3f covariance = Mat3f::Zero();
    for (const auto& n : near)
        covariance += (points[n.index] - mean) * (points[n.index] - mean).transpose();
    Eigen::SelfAdjointEigenSolver<Mat3f> solver;
    solver.computeDirect(covariance);
    return solver.eigenvectors().col(0);
}

void mark_rim(const geometry::TriangleMesh& mesh, Observation& out) {
    std::map<std::array<std::uint32_t, 2>, int> edges;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            ++edges[{std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])}];
    std::vector<Vec3f> border;
    for (const auto& [edge, count] : edges)
        if (count == 1)
            for (const auto v : edge)
                border.push_back(mesh.positions[v]);
    if (border.empty()) return;
    const geometry::PointTree tree(border);
    out.rim.resize(out.points.size());
    for (std::size_t i = 0; i < out.points.size(); ++i)
        out.rim[i] = tree.nearest(out.points[i]).squared < kRim * kRim ? 1 : 0;
}

} // namespace

std::optional<DepthView::Sight> DepthView::sight(const Vec3f& point) const {
    const Vec3d local = world_from_camera.inverse(Eigen::Isometry) * point.cast<double>();
    const auto pixel = imaging::project(camera, local);
    if (!pixel) return std::nullopt;
    const int x = static_cast<int>(std::lround(pixel->x()));
    const int y = static_cast<int>(std::lround(pixel->y()));
    if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) return std::nullopt;
    return Sight{static_cast<float>(-local.z()), x, y};
}

Observation sampled(const geometry::TriangleMesh& mesh, std::size_t count) {
    std::vector<double> upto;
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        area += 0.5 * static_cast<double>((b - a).cross(c - a).norm());
        upto.push_back(area);
    }
    if (!(area > 0.0)) throw Error("the scan's triangles have no area");
    Observation out;
    Random random(1);
    std::size_t triangle = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = area * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        while (triangle + 1 < upto.size() && upto[triangle] < at)
            ++triangle;
        const Triangle& t = mesh.triangles[triangle];
        const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        auto u = static_cast<float>(random.uniform(0.0, 1.0));
        auto v = static_cast<float>(random.uniform(0.0, 1.0));
        if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
        out.points.push_back(a + u * (b - a) + v * (c - a));
        out.normals.push_back((b - a).cross(c - a).normalized());
        out.areas.push_back(static_cast<float>(area / static_cast<double>(count)));
    }
    out.complete = true;
    mark_rim(mesh, out);
    return out;
}

Observation thinned(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                    std::size_t count) {
    Observation out;
    const geometry::PointTree tree(points);
    Vec3f middle = Vec3f::Zero();
    for (const Vec3f& p : points)
        middle += p / static_cast<float>(points.size());
    for (const std::size_t i : spread(points.size(), count)) {
        out.points.push_back(points[i]);
        const auto near = tree.nearest(points[i], kNormalNeighbours);
        Vec3f normal = normals.empty() ? plane_normal(points, near) : normals[i];
        const Vec3f outwards(points[i].x() - middle.x(), 0.0f, points[i].z() - middle.z());
        if (normals.empty() && normal.dot(outwards) < 0.0f) normal = -normal;
        out.normals.push_back(normal);
        // A disc that holds the neighbours, shared among them.
        const float share =
            static_cast<float>(M_PI) * near.back().squared / static_cast<float>(near.size());
        out.areas.push_back(share * static_cast<float>(points.size()) /
                            static_cast<float>(std::min(points.size(), count)));
    }
    return out;
}

Observation seen(std::shared_ptr<const DepthView> view, std::span<const std::uint8_t> mask) {
    const imaging::DepthUnprojector unprojector(view->camera);
    std::vector<Vec3f> points(view->depth.metres.size());
    unprojector.points(view->depth.metres, points);
    const Eigen::Isometry3f place = view->world_from_camera.cast<float>();
    Observation out;
    const auto pixel = static_cast<float>(1.0 / (view->camera.fx * view->camera.fy));
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (mask[i] == 0 || !points[i].allFinite()) continue;
        out.points.push_back(place * points[i]);
        out.areas.push_back(points[i].z() * points[i].z() * pixel); // across the line of sight
        if (!view->color.empty()) out.hues.push_back(hue_of(&view->color.pixels[4 * i]));
    }
    out.eye = place.translation();
    out.outline = outline(*view, mask);
    out.view = std::move(view);
    return out;
}

} // namespace toile::scape_fit
