// Nearest points on a surface, inside or outside, and rays against it (Embree).
#pragma once

#include "core/types.h"

#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace toile::geometry {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct SurfacePoint {
    std::uint32_t triangle = kNoTriangle; ///< kNoTriangle: nothing within the radius
    Vec3f barycentric = Vec3f::Zero();    ///< weights of the triangle's corners, sum 1
    Vec3f point = Vec3f::Zero();          ///< on the surface, metres
    Vec3f normal = Vec3f::Zero();         ///< angle-weighted pseudo-normal there, unit length
    float distance = std::numeric_limits<float>::infinity(); ///< metres, not negative
    /// Negative inside. Right for closed surfaces; beside a border it is the side of the sheet.
    float signed_distance = std::numeric_limits<float>::infinity();
};

struct RayHit {
    std::uint32_t triangle = kNoTriangle;
    Vec3f barycentric = Vec3f::Zero();
    float distance = 0.0f; ///< in lengths of the direction
};

/// A search tree over one surface: built once, refitted when its vertices move, queried often.
/// Queries are const, allocate nothing and may run on many threads at once; `refit` may not run
/// beside them. Results of `nearest` do not depend on the tree: of several triangles at the same
/// distance the one with the lowest number is taken.
class NearestSurface {
  public:
    /// Copies what it needs. \throw Error when an index is out of range, a vertex not finite, or
    /// there are no triangles
    NearestSurface(std::span<const Vec3f> positions, std::span<const Triangle> triangles);
    ~NearestSurface();
    NearestSurface(NearestSurface&&) noexcept;
    NearestSurface& operator=(NearestSurface&&) noexcept;

    /// New places of the same vertices. Non-finite vertices keep their old places.
    /// \throw Error when the count differs
    void refit(std::span<const Vec3f> positions);

    [[nodiscard]] SurfacePoint
    nearest(const Vec3f& point,
            float max_distance = std::numeric_limits<float>::infinity()) const noexcept;

    /// The same for each of `points`; `results` has the same size.
    void nearest(std::span<const Vec3f> points, std::span<SurfacePoint> results,
                 float max_distance = std::numeric_limits<float>::infinity()) const noexcept;

    /// First triangle met within (`from`, `to`) lengths of the direction. A ray through an edge
    /// may report either of its triangles.
    [[nodiscard]] std::optional<RayHit>
    first_hit(const Vec3f& origin, const Vec3f& direction, float from = 0.0f,
              float to = std::numeric_limits<float>::infinity()) const noexcept;

    /// Whether anything is met at all; faster.
    [[nodiscard]] bool blocked(const Vec3f& origin, const Vec3f& direction, float from = 0.0f,
                               float to = std::numeric_limits<float>::infinity()) const noexcept;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

} // namespace toile::geometry
