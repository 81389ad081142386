// A body's bulk, measured on its rest surface: what an arm must stay out of, and how thick it is.
#pragma once

#include "body/body_model.h"
#include "body/skeleton.h"

#include <array>
#include <span>
#include <vector>

namespace toile::body {

/// Trunk as radii over height and angle about an axis, in rest coordinates (metres).
struct TrunkProfile {
    static constexpr std::size_t kAngles = 24;
    static constexpr std::size_t kSlices = 20;
    float bottom = 0.0f;                                    ///< height of the first slice
    float step = 0.0f;                                      ///< between slices
    std::array<Vec2f, kSlices> axis;                        ///< x, z of the axis
    std::array<std::array<float, kAngles>, kSlices> radius; ///< angle 0 to +X, rising to +Z

    /// Radius at a height and angle, and the axis there; 0 outside of the heights.
    [[nodiscard]] float at(float height, float angle) const noexcept;
    [[nodiscard]] Vec2f axis_at(float height) const noexcept;
};

/// A tapered capsule along a bone.
struct LimbProfile {
    float start_radius = 0.0f;
    float end_radius = 0.0f;
};

struct BodyVolumes {
    TrunkProfile trunk;
    Vec3f head_centre = Vec3f::Zero(); ///< rest coordinates
    Vec3f head_radii = Vec3f::Zero();
    std::array<LimbProfile, 2> upper_arm; ///< left, right; start at mid-bone, end at the elbow
    std::array<LimbProfile, 2> lower_arm;
    std::array<LimbProfile, 2> thigh;
    std::array<Vec3f, 2> fingertip; ///< rest coordinates
    float hand_radius = 0.03f;

    /// How deep a world point is inside trunk, head or thighs, and the way out (world, unit).
    struct Depth {
        float depth = -1.0f; ///< metres, positive inside
        Vec3f out = Vec3f::Zero();
    };
    /// `radius` is added all round. `skeleton` is that of the same body.
    [[nodiscard]] Depth depth(const Vec3f& point, float radius, const Skeleton& skeleton,
                              const JointTransforms& world) const noexcept;
};

/// positions (nv) and parts (nv) of the rest surface. \throw Error when a part has no vertex
[[nodiscard]] BodyVolumes measure_volumes(const Skeleton& skeleton,
                                          std::span<const Vec3f> positions,
                                          std::span<const Part> parts);

} // namespace toile::body
