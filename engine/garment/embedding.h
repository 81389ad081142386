// Hangs render meshes on a simulation mesh: each render vertex keeps its place relative to the
// nearest triangle, so that it follows the cloth frame by frame.
#pragma once

#include "garment/package.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::garment {

/// One render vertex in the frame of a simulation triangle: sum of barycentric * corner, plus
/// `offset` in the frame (first edge made orthogonal to the smooth normal, its cross product,
/// smooth normal). Exact at rest.
struct EmbeddedVertex {
    std::uint32_t triangle = 0;
    Vec3f barycentric = Vec3f::Zero();
    Vec3f offset = Vec3f::Zero(); ///< metres: along edge, across, along the normal
};

/// Render meshes of one size embedded in its simulation mesh. Built once, evaluated per frame.
class SurfaceEmbedding {
  public:
    /// One primitive of GarmentSize::render.
    struct Part {
        std::size_t mesh = 0;
        std::size_t primitive = 0;
        double max_distance = 0.0;            ///< metres, of any vertex from the simulation mesh
        std::vector<std::uint32_t> welded;    ///< (nr) welded vertex of each render vertex
        std::vector<Triangle> triangles;      ///< of the welded vertices
        std::vector<EmbeddedVertex> vertices; ///< (welded)
    };

    explicit SurfaceEmbedding(const GarmentSize& size);

    [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

    /// What `evaluate` needs of memory, allocated once.
    struct Scratch {
        std::vector<Vec3f> positions; ///< (largest part, welded)
        std::vector<Vec3f> normals;
    };
    [[nodiscard]] Scratch make_scratch() const;

    /// Positions and smooth unit normals (nr) of one part for the cloth as it is now.
    /// `simulation_normals` are unit vertex normals (nv). Allocates nothing.
    void evaluate(std::size_t part, std::span<const Vec3f> simulation_positions,
                  std::span<const Vec3f> simulation_normals, Scratch& scratch,
                  std::span<Vec3f> positions, std::span<Vec3f> normals) const noexcept;

    /// A quantity of the simulation vertices (nv) at the render vertices (nr) of one part.
    void spread(std::size_t part, std::span<const float> simulation_values,
                std::span<float> values) const noexcept;

    /// Triangles of one part that hang on simulation triangles which are not `hidden` (nf, 1 or 0)
    /// with at least one corner; all of them when `hidden` is empty. (nt) into the render vertices.
    [[nodiscard]] std::vector<Triangle> uncovered(std::size_t part,
                                                  std::span<const Triangle> render_triangles,
                                                  std::span<const std::uint8_t> hidden) const;

  private:
    std::vector<Triangle> simulation_triangles_;
    std::vector<Part> parts_;
};

} // namespace toile::garment
