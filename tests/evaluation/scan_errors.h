// How far a scanned surface is from the true one.
#pragma once

#include "geometry/mesh.h"

#include <span>
#include <string>

namespace toile::evaluation {

struct Deviation {
    double mean_m = 0.0, p95_m = 0.0, most_m = 0.0;
};

/// Distances of the points to the surface, sides not told apart. `weights` (points) or none: what
/// each counts.
[[nodiscard]] Deviation deviation(std::span<const Vec3f> points,
                                  const geometry::TriangleMesh& surface,
                                  std::span<const double> weights = {});

/// (nv) a third of the area around each vertex, m^2.
[[nodiscard]] std::vector<double> vertex_areas(const geometry::TriangleMesh& mesh);

/// Rigid motion that lays the points on the surface (point to plane, trimmed).
[[nodiscard]] Eigen::Isometry3d best_motion(std::span<const Vec3f> points,
                                            const geometry::TriangleMesh& surface);

/// Convex girth of the largest closed curve at a height, metres; 0: none.
[[nodiscard]] double girth_at(const geometry::TriangleMesh& mesh, float height);

/// A mesh file, or the first frame of a recording's truth (a surface cache's folder). \throw Error
[[nodiscard]] geometry::TriangleMesh load_truth(const std::string& name);

/// Prints distances, as the scan stands and laid on the truth, both ways, each vertex by its area
/// (fingers have many), and girths at heights.
void compare(const geometry::TriangleMesh& scan, const geometry::TriangleMesh& truth,
             std::span<const float> heights);

} // namespace toile::evaluation
