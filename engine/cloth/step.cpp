#include "cloth/step.h"

#include <algorithm>
#include <cmath>

namespace toile::cloth {
namespace {

constexpr double kLongestStep = 1.0; // s
constexpr float kFarthest = 1000.0f; // m

bool sound(std::span<const Vec3f> points) {
    // NaN fails every comparison.
    return std::all_of(points.begin(), points.end(), [](const Vec3f& p) {
        return std::abs(p.x()) < kFarthest && std::abs(p.y()) < kFarthest &&
               std::abs(p.z()) < kFarthest;
    });
}

StepResult check_frame(const GarmentFrame& frame, const StepInput& input,
                       std::span<const KnownGarment> known) noexcept {
    const auto found = std::find_if(known.begin(), known.end(), [&](const KnownGarment& garment) {
        return garment.handle == frame.garment;
    });
    if (found == known.end()) {
        return StepResult::unknown_garment;
    }
    const auto same = [&](const GarmentFrame& other) { return other.garment == frame.garment; };
    if (std::count_if(input.garments.begin(), input.garments.end(), same) != 1) {
        return StepResult::garment_count;
    }
    if (frame.targets.size() != found->vertex_count) {
        return StepResult::target_count;
    }
    if (!sound(frame.targets)) {
        return StepResult::target_values;
    }
    if (frame.positions.size() != found->vertex_count ||
        frame.normals.size() != found->vertex_count) {
        return StepResult::output_count;
    }
    return StepResult::ok;
}

} // namespace

const char* step_result_text(StepResult result) noexcept {
    switch (result) {
    case StepResult::ok:
        return "done";
    case StepResult::recovered:
        return "a garment was not finite and began anew from its targets";
    case StepResult::no_body:
        return "step: no body; call set_body first";
    case StepResult::body_count:
        return "step: the posed body has another vertex count than the body that was set";
    case StepResult::body_values:
        return "step: a position of the posed body is not finite or out of range";
    case StepResult::time:
        return "step: dt must be greater than 0 and at most 1 s; pass the reset flag after a gap";
    case StepResult::garment_count:
        return "step: must name every garment of the world exactly once";
    case StepResult::unknown_garment:
        return "step: names a garment that was not added or was removed";
    case StepResult::target_count:
        return "step: a garment's targets have another count than its vertices";
    case StepResult::target_values:
        return "step: a target is not finite or out of range";
    case StepResult::output_count:
        return "step: a garment's output buffers have another count than its vertices";
    }
    return "unknown";
}

StepResult check_step(const StepInput& input, std::size_t body_vertices,
                      std::span<const KnownGarment> known) noexcept {
    if (body_vertices == 0) {
        return StepResult::no_body;
    }
    if (input.body_before.size() != body_vertices || input.body_after.size() != body_vertices) {
        return StepResult::body_count;
    }
    if (!sound(input.body_before) || !sound(input.body_after)) {
        return StepResult::body_values;
    }
    const bool first = input.reset && input.dt_s == 0.0;
    if (!first && !(input.dt_s > 0.0 && input.dt_s <= kLongestStep)) {
        return StepResult::time;
    }
    if (input.garments.size() != known.size()) {
        return StepResult::garment_count;
    }
    for (const GarmentFrame& frame : input.garments) {
        const StepResult result = check_frame(frame, input, known);
        if (result != StepResult::ok) {
            return result;
        }
    }
    return StepResult::ok;
}

void write_frame(std::span<const Vec4f> positions, std::span<const Triangle> triangles,
                 const GarmentFrame& frame, std::span<const std::uint32_t> vertex) noexcept {
    const auto place = [&](std::size_t row) { return vertex.empty() ? row : vertex[row]; };
    for (std::size_t v = 0; v < positions.size(); ++v) {
        frame.positions[place(v)] = positions[v].head<3>();
    }
    std::fill(frame.normals.begin(), frame.normals.end(), Vec3f::Zero());
    for (const Triangle& corner : triangles) {
        const Vec3f a = positions[corner[0]].head<3>();
        const Vec3f area =
            (positions[corner[1]].head<3>() - a).cross(positions[corner[2]].head<3>() - a);
        for (const std::uint32_t v : corner) {
            frame.normals[place(v)] += area;
        }
    }
    for (Vec3f& normal : frame.normals) {
        const float length = normal.norm();
        normal = length > 0.0f ? Vec3f(normal / length) : Vec3f::UnitY();
    }
}

} // namespace toile::cloth
