// Joints to a posed surface: linear blend and dual quaternion skinning.
#pragma once

#include "body/skeleton.h"

#include <cstddef>
#include <span>
#include <vector>

namespace toile::body {

enum class SkinningMethod : std::uint8_t {
    invalid,
    linear_blend,    ///< blends matrices: cheapest, loses volume at a strong twist
    dual_quaternion, ///< blends rigid motions (Kavan 2007): keeps volume, may bulge at a bend
};

/// Rows of three floats somewhere else, `stride` bytes apart; borrowed. Data null: not wanted.
struct VectorRows {
    float* data = nullptr;
    std::size_t stride = sizeof(float) * 3;

    VectorRows() = default;
    VectorRows(float* rows, std::size_t bytes) : data(rows), stride(bytes) {}
    explicit VectorRows(std::span<Vec3f> rows)
        : data(rows.empty() ? nullptr : rows.front().data()), stride(sizeof(Vec3f)) {}
};

/// A rest surface with its weights, copied into the layout that posing wants.
/// Built once per body; `pose` is const, allocates nothing and may run on any thread.
class SkinnedSurface {
  public:
    /// positions (nv), metres; normals (nv) or empty; joints and weights (nv), at least one row sum
    /// of 1 within 1e-3 (rows are scaled to sum to 1).
    /// \throw Error naming the vertex that has a bad joint, weight or coordinate
    SkinnedSurface(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                   std::span<const std::array<std::uint16_t, 4>> joints,
                   std::span<const std::array<float, 4>> weights);

    [[nodiscard]] std::size_t vertex_count() const noexcept { return vertices_.size(); }

    /// Writes (nv) posed positions, and unit normals where wanted. `skinning` maps rest points of
    /// each joint into the world: see skinning_transforms.
    void pose(const JointTransforms& skinning, SkinningMethod method, VectorRows positions,
              VectorRows normals) const noexcept;

  private:
    /// 64 bytes: one cache line a vertex.
    struct alignas(64) Vertex {
        std::array<float, 3> position;
        std::array<float, 3> normal;
        std::array<float, 4> weights;        ///< falling
        std::array<std::uint16_t, 4> joints; ///< unused slots repeat the first joint
    };

    void pose_linear(const JointTransforms& skinning, VectorRows positions,
                     VectorRows normals) const noexcept;
    void pose_dual_quaternion(const JointTransforms& skinning, VectorRows positions,
                              VectorRows normals) const noexcept;

    std::vector<Vertex> vertices_;
};

} // namespace toile::body
