// One frame as a world of cloth is told it, checked before anything changes.
#pragma once

#include "core/types.h"

#include <span>

namespace toile::cloth {

/// One garment in and out of a step; (nv) each.
struct GarmentFrame {
    std::uint32_t garment = 0; ///< handle
    std::span<const Vec3f> targets;
    std::span<Vec3f> positions, normals;
};

struct StepInput {
    std::span<const Vec3f> body_before, body_after; ///< (body nv) metres
    double dt_s = 0.0;
    bool reset = false;
    std::span<const GarmentFrame> garments; ///< every garment of the world, in any order
};

enum class StepResult {
    ok,
    recovered, ///< a garment had become non-finite and was started anew from its targets
    no_body,
    body_count,    ///< body_before or body_after has another vertex count than the body
    body_values,   ///< not finite, or further than a kilometre
    time,          ///< dt is not in (0, 1] s; with reset [0, 1] s
    garment_count, ///< not exactly the garments of the world
    unknown_garment,
    target_count,
    target_values, ///< not finite, or further than a kilometre
    output_count
};

/// What to tell a person about a result; lives as long as the program.
[[nodiscard]] const char* step_result_text(StepResult result) noexcept;

/// A garment that the world has.
struct KnownGarment {
    std::uint32_t handle;
    std::size_t vertex_count;
};

/// Is a step sound for a world of these garments and a body of so many vertices (0: none)?
/// Answers with the first fault. Nothing is allocated.
[[nodiscard]] StepResult check_step(const StepInput& input, std::size_t body_vertices,
                                    std::span<const KnownGarment> known) noexcept;

/// Copies a garment's vertices out, with unit normals from the areas around each. Row r is vertex
/// `vertex[r]` of the frame; (nv), or empty: they are in the frame's order.
void write_frame(std::span<const Vec4f> positions, std::span<const Triangle> triangles,
                 const GarmentFrame& frame, std::span<const std::uint32_t> vertex = {}) noexcept;

} // namespace toile::cloth
