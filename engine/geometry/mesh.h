// Triangle meshes as plain arrays, and the checks that make them fit for use.
#pragma once

#include "core/types.h"

#include <span>
#include <string>
#include <vector>

namespace toile::geometry {

/// A welded triangle mesh: metres, counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vec3f> positions;    ///< (nv)
    std::vector<Vec3f> normals;      ///< (nv), or empty
    std::vector<Triangle> triangles; ///< (nf)
};

/// The same surface cut along texture seams, for drawing and for files that need it.
/// Triangle i of `triangles` is triangle i of the welded mesh.
struct SeamedLayout {
    std::vector<std::uint32_t> welded; ///< (nr) welded vertex of each seamed vertex
    std::vector<Vec2f> texcoords;      ///< (nr) origin at the top left, as in glTF
    std::vector<Triangle> triangles;   ///< (nf) into the seamed vertices
};

/// What `check_topology` found; all zero for a closed, oriented 2-manifold in one piece.
struct TopologyReport {
    std::size_t out_of_range = 0; ///< triangles with an index >= nv
    std::size_t degenerate = 0;   ///< triangles that name a vertex twice
    std::size_t non_finite = 0;   ///< vertices with NaN or infinity
    std::size_t unused_vertices = 0;
    std::size_t boundary_edges = 0;        ///< edges with one triangle
    std::size_t non_manifold_edges = 0;    ///< edges with more than two triangles
    std::size_t misoriented_edges = 0;     ///< edges run through twice in one direction
    std::size_t non_manifold_vertices = 0; ///< vertices whose triangles form several fans
    std::size_t components = 0;            ///< edge-connected pieces

    /// Safe to index and to compute on (borders allowed).
    [[nodiscard]] bool usable() const { return out_of_range + degenerate + non_finite == 0; }
    [[nodiscard]] bool manifold() const {
        return usable() && non_manifold_edges + misoriented_edges + non_manifold_vertices == 0;
    }
    [[nodiscard]] bool closed() const { return manifold() && boundary_edges == 0; }
    /// One line naming what is wrong, "" when manifold.
    [[nodiscard]] std::string text() const;
};

[[nodiscard]] TopologyReport check_topology(std::span<const Vec3f> positions,
                                            std::span<const Triangle> triangles);

/// Area-weighted vertex normals, unit length (zero where a vertex has no area). `normals` (nv).
void vertex_normals(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                    std::span<Vec3f> normals) noexcept;

[[nodiscard]] double surface_area(const TriangleMesh& mesh);
/// Signed volume, positive for a closed mesh oriented outwards; m^3.
[[nodiscard]] double volume(const TriangleMesh& mesh);

/// Neighbours of each vertex in compressed rows, sorted: those of v are
/// `neighbours[first[v] .. first[v + 1])`.
struct VertexAdjacency {
    std::vector<std::uint32_t> first; ///< (nv + 1)
    std::vector<std::uint32_t> neighbours;
};
[[nodiscard]] VertexAdjacency vertex_adjacency(std::size_t vertex_count,
                                               std::span<const Triangle> triangles);
/// Triangles at each vertex, same layout.
[[nodiscard]] VertexAdjacency vertex_triangles(std::size_t vertex_count,
                                               std::span<const Triangle> triangles);

/// Merges vertices with bitwise equal positions. `layout` gets the seamed view of the input.
[[nodiscard]] TriangleMesh weld(std::span<const Vec3f> positions,
                                std::span<const Triangle> triangles,
                                std::span<const Vec2f> texcoords, SeamedLayout& layout);

} // namespace toile::geometry
