// Lets a sewn block settle on its body: position-based cloth, quasi-static, set-up time only.
#pragma once

#include "garment/block_assembly.h"
#include "garment/block_field.h"

namespace toile::garment::block {

struct DrapeOptions {
    double clearance_m = 0.010; ///< of vertices from the skin
    double density_kg_m2 = 0.18;
    double stretch_n_m = 600.0; ///< force per width per unit strain
    double bending = 0.10;      ///< share of a hinge's error mended per iteration
    double friction = 0.05;
    int shrink_steps = 300;   ///< without gravity, from the first guess to the flat sizes
    int settle_steps = 900;   ///< with gravity
    int finish_steps = 1600;  ///< with gravity, five times shorter: takes out the stretch
    int iterations = 6;       ///< per step of 1/240 s
    double rest_m_s = 0.05;   ///< a garment that still moves faster is refused
    double most_strain = 1.0; ///< and one with an edge that is stretched further
};

/// An edge of the welded mesh and its length in the flat pattern (mean over both sides of a seam).
struct RestEdge {
    std::uint32_t a = 0, b = 0;
    double length = 0.0;
};
[[nodiscard]] std::vector<RestEdge> rest_edges(std::span<const Triangle> triangles,
                                               std::span<const Vec2f> material_coords);

/// How a drape ended.
struct DrapeReport {
    double rms_speed = 0.0;       ///< m/s, of the way made in the last tenth of a second
    std::uint32_t fastest = 0;    ///< the vertex that went farthest
    double worst_strain = 0.0;    ///< of an edge
    std::uint32_t worst_edge = 0; ///< a vertex of that edge
    double dropped_m = 0.0;       ///< how far the mean height sank under gravity
};

/// Moves `block.positions` to rest. `held` (nv) is 1 where a vertex keeps its place. The result is
/// symmetric, if the pattern is, but for what contact with the body asks.
DrapeReport drape(const Assembly& assembly, SizedBlock& block, const DistanceField& body,
                  std::span<const std::uint8_t> held, const DrapeOptions& options);

} // namespace toile::garment::block
