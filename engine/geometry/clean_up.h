// From a scan as it comes to one clean surface (P3 3.2).
#pragma once

#include "geometry/mesh.h"

namespace toile::geometry {

struct CleanUpOptions {
    float merge_m = 1e-4f;          ///< nearer points are one, metres
    std::size_t largest_hole = 400; ///< border edges of holes that are filled; longer ones stay
    double smoothing = 0.4;         ///< lambda of P3 eq. 4; 0: none
    int smoothing_rounds = 1;
};

/// What was found and mended.
struct CleanUpReport {
    std::size_t merged_points = 0;      ///< beyond the first in their place
    std::size_t dropped_triangles = 0;  ///< without area, twice there, or of unusable points
    std::size_t non_manifold_edges = 0; ///< a triangle too many was taken away
    std::size_t dropped_pieces = 0;     ///< beside the largest
    std::size_t filled_holes = 0, open_holes = 0;
    double smoothing_rms_m = 0.0; ///< how far points moved
};

struct CleanMesh {
    TriangleMesh mesh;                 ///< oriented outwards, manifold, one piece; with normals
    std::vector<std::uint32_t> source; ///< (nv) a vertex of the scan at, or near, each vertex
    CleanUpReport report;
};

/// Duplicates merged; of more than two triangles at an edge those two stay whose normals differ
/// least; the largest piece; holes filled; smoothed by the mean curvature. Any indices, any
/// points: what is not finite or out of range is left out. \throw Error when nothing is left
[[nodiscard]] CleanMesh clean_up(const TriangleMesh& scan, const CleanUpOptions& options = {});

/// One implicit step of the normalised mean curvature flow: (I + lambda K) X' = X, with P3 eq. 5's
/// K (the paper prints a minus, which roughens). \throw Error when the system cannot be solved
[[nodiscard]] std::vector<Vec3f> smoothed(const TriangleMesh& mesh, double lambda);

} // namespace toile::geometry
