#include "scan/warped_view.h"

#include "geometry/nearest_surface.h"

#include <cmath>
#include <limits>

namespace toile::scan {
namespace {

Warp matrix_of(const Pose& pose) {
    return pose.matrix().topRows<3>().cast<float>();
}

} // namespace

void WarpedView::update_motions() {
    motions.resize(base.size());
    for (std::size_t n = 0; n < base.size(); ++n)
        motions[n] = matrix_of(moved[n] * base[n]);
}

void WarpedView::settle() {
    for (std::size_t n = 0; n < base.size(); ++n) {
        base[n] = moved[n] * base[n];
        moved[n] = Pose::Identity();
    }
}

std::vector<Warp> WarpedView::inverse_motions() const {
    std::vector<Warp> out;
    out.reserve(base.size());
    for (std::size_t n = 0; n < base.size(); ++n)
        out.push_back(matrix_of((moved[n] * base[n]).inverse()));
    return out;
}

std::vector<Vec3f> posed_template(const DeformationGraph& graph, std::span<const Vec3f> positions,
                                  std::span<const Warp> camera_from_scan) {
    std::vector<Vec3f> out;
    out.reserve(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v)
        out.push_back(warped(blended(graph.bindings()[v], camera_from_scan), positions[v]));
    return out;
}

void bind(const DeformationGraph& graph, const geometry::TriangleMesh& shape,
          const BindingOptions& options, WarpedView& view, int stride) {
    const std::vector<Vec3f> posed = posed_template(graph, shape.positions, view.inverse_motions());
    const geometry::NearestSurface surface(posed, shape.triangles);
    const Window& camera = view.view.camera;
    view.bindings.assign(camera.count(), {});
    for (int y = 0; y < camera.height; y += stride)
        for (int x = 0; x < camera.width; x += stride) {
            const std::size_t i = camera.at(x, y);
            if (view.view.depth[i] == 0.0f) continue;
            const auto near = surface.nearest(view.view.point(x, y), options.reach_m);
            if (near.triangle == geometry::kNoTriangle) continue;
            const bool opposed = near.normal.dot(view.view.normals[i]) < 0.0f;
            if (opposed && near.distance > options.opposed_m) continue;
            view.bindings[i] = graph.at(shape.triangles[near.triangle], near.barycentric);
        }
}

PulledView pulled(const WarpedView& view) {
    const Window& camera = view.view.camera;
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    PulledView out;
    out.points.assign(camera.count(), Vec3f::Constant(nothing));
    out.normals.assign(camera.count(), Vec3f::Zero());
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const std::size_t i = camera.at(x, y);
            if (view.view.weight[i] <= 0.0f || view.view.depth[i] == 0.0f || !view.bound(i))
                continue;
            const Warp move = blended(view.bindings[i], view.motions);
            out.points[i] = warped(move, view.view.point(x, y));
            out.normals[i] = (move.leftCols<3>() * view.view.normals[i]).normalized();
        }
    return out;
}

PreparedView prepared(const WarpedView& view) {
    return {pulled(view), view.inverse_motions()};
}

bool find_partner(const NodeBinding& binding, const Vec3f& place, const WarpedView& to,
                  const PreparedView& to_at, std::size_t& pixel) {
    int u = 0, v = 0;
    if (!to.view.camera.pixel(warped(blended(binding, to_at.inverse), place), u, v)) return false;
    pixel = to.view.camera.at(u, v);
    const Vec3f& q = to_at.pulled.points[pixel];
    return q.x() == q.x();
}

Pose overall_pose(const WarpedView& view, const DeformationGraph& graph) {
    std::vector<Vec3f> seen, scan;
    for (std::size_t n = 0; n < view.base.size(); ++n) {
        const Pose move = view.moved[n] * view.base[n];
        scan.push_back(graph.nodes()[n]);
        seen.push_back((move.inverse() * graph.nodes()[n].cast<double>()).cast<float>());
    }
    std::vector<float> weights(seen.size(), 1.0f);
    Pose out = best_rigid(seen, scan, weights);
    // Nodes of limbs that moved count less.
    for (int round = 0; round < 5; ++round) {
        for (std::size_t n = 0; n < seen.size(); ++n) {
            const double off =
                (out * seen[n].cast<double>() - scan[n].cast<double>()).norm() / 0.03;
            weights[n] = static_cast<float>(1.0 / (1.0 + off * off));
        }
        out = best_rigid(seen, scan, weights);
    }
    return out;
}

} // namespace toile::scan
