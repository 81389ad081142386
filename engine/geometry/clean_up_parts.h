// The steps of clean_up, in their order. Private to this folder.
#pragma once

#include "geometry/clean_up.h"

namespace toile::geometry {

/// Fills `out` with the scan's points, those within `radius` of each other as one.
void merge_points(const TriangleMesh& scan, float radius, CleanMesh& out);
/// Triangles that name a point twice or stand there twice.
void drop_bad_triangles(CleanMesh& out);
/// Of more than two triangles at an edge the two stay that go on most smoothly (P3, figure 3).
void drop_extra_at_edges(CleanMesh& out);
/// Turns triangles so that each runs through its edges against its neighbours, piece by piece
/// (none can be on a one-sided piece: it is cut open).
void orient_alike(CleanMesh& out);
/// The connected piece with the most triangles; points that nothing uses go.
void keep_largest_piece(CleanMesh& out);
/// A vertex whose triangles form several fans becomes one vertex a fan.
void split_pinched_vertices(CleanMesh& out);
/// Closes borders of at most `largest` edges.
void fill_holes(std::size_t largest, CleanMesh& out);

} // namespace toile::geometry
