// The body as cloth meets it: a surface that moves during the step, and nearest points on it found
// by walking from triangle to triangle.
#pragma once

#include "core/types.h"
#include "geometry/surface_walk.h"

#include <array>

namespace toile::cloth {

/// Positions and other per-vertex vectors: x y z, and 0.
using Vec4 = Vec4f;

inline constexpr std::uint32_t kNone = geometry::kNoTriangle;
inline constexpr std::size_t kBodyJoints = 22;

/// A set of joints, one bit each.
using JointMask = std::uint32_t;

/// What never changes of a body. Views are borrowed for the call.
struct BodyRest {
    std::span<const Vec3f> positions;                     ///< (nv) metres, rest pose
    std::span<const Triangle> triangles;                  ///< (nf)
    std::span<const std::array<std::uint16_t, 4>> joints; ///< (nv)
    std::span<const std::array<float, 4>> weights;        ///< (nv)
};

using SurfacePoint = geometry::WalkPoint;

class MovingBody {
  public:
    /// \throw Error when counts differ, an index is out of range or a position is not finite
    explicit MovingBody(const BodyRest& rest);

    /// Where the vertices stand at the start and the end of a step of `dt` seconds; (nv) each.
    void set_motion(std::span<const Vec3f> before, std::span<const Vec3f> after, float dt) noexcept;
    /// Moves the surface to a fraction of the step.
    void place(float fraction) noexcept;

    /// Goes downhill from `start` over triangles of the joints in `allowed`.
    [[nodiscard]] SurfacePoint walk(const Vec4& p, std::uint32_t start,
                                    JointMask allowed) const noexcept {
        return surface_.walk(now_, p, start, allowed);
    }
    /// Interpolated unit normal, and velocity (m/s), at a point found by `walk`.
    [[nodiscard]] Vec4 normal_at(const SurfacePoint& at) const noexcept;
    [[nodiscard]] Vec4 velocity_at(const SurfacePoint& at) const noexcept;

    /// Triangle to start from when looking for a joint's part of the surface, or kNone when `p`
    /// is further than `reach` plus what the part may move in `period` seconds.
    [[nodiscard]] std::uint32_t start_on(std::size_t joint, const Vec4& p, float reach,
                                         float period) const noexcept;

    /// m/s, of the fastest point of a joint's part in this step.
    [[nodiscard]] float speed_of(std::size_t joint) const noexcept { return parts_[joint].speed; }

    [[nodiscard]] std::size_t vertex_count() const noexcept { return now_.size(); }
    [[nodiscard]] std::span<const Triangle> triangles() const noexcept {
        return surface_.triangles();
    }
    [[nodiscard]] std::span<const Vec4> positions() const noexcept { return now_; }
    [[nodiscard]] std::span<const Vec4> normals() const noexcept { return normal_; }
    [[nodiscard]] std::uint8_t joint_of(std::uint32_t triangle) const noexcept {
        return surface_.group_of(triangle);
    }
    /// Neighbour across side k (from corner k to k + 1), or kNone.
    [[nodiscard]] std::uint32_t across(std::uint32_t triangle, std::size_t side) const noexcept {
        return surface_.across(triangle, side);
    }

  private:
    /// Points spread over the part of one joint, and a ball of each.
    struct Part {
        std::vector<std::uint32_t> vertices;  ///< seeds
        std::vector<std::uint32_t> triangles; ///< one at each seed
        std::vector<float> x, y, z;           ///< of the seeds, now
        float spacing = 0.0f;                 ///< m, no vertex of the part is further from a seed
        float speed = 0.0f;                   ///< m/s, of the fastest seed in this step
        Vec4 low = Vec4::Zero(), high = Vec4::Zero();
    };

    void choose_seeds(std::span<const Vec3f> rest, std::span<const std::uint8_t> vertex_joint);
    void compute_normals(std::span<const Vec4> positions, std::span<Vec4> normals) const noexcept;

    geometry::SurfaceWalk surface_; ///< groups: the joint that moves a triangle most
    std::array<Part, kBodyJoints> parts_;
    std::vector<Vec4> before_, after_, now_;
    std::vector<Vec4> normal_before_, normal_after_, normal_;
    float per_second_ = 0.0f; ///< 1 / dt
};

} // namespace toile::cloth
