// Level sections of an upright surface, and how they hang together: the skeleton of what an unknown
// body is made of.
#pragma once

#include "core/types.h"
#include "geometry/slice.h"

#include <span>
#include <vector>

namespace toile::body {

/// One closed curve of a level section. Horizontal coordinates: x, z.
struct Outline {
    std::vector<Vec3f> points;
    Vec2f centroid = Vec2f::Zero(); ///< of the area inside
    double area = 0.0;              ///< m^2; negative around a hollow
    Vec2f low = Vec2f::Zero(), high = Vec2f::Zero();
    [[nodiscard]] double girth() const; ///< of a tape pulled tight around it, m
    [[nodiscard]] bool contains(const Vec2f& p) const;
};

/// Cuts one closed surface at any height; keeps its triangles sorted by height, so that a cut costs
/// what it meets. Borrows the surface.
class Sections {
  public:
    Sections(std::span<const Vec3f> positions, std::span<const Triangle> triangles);

    [[nodiscard]] float floor() const { return floor_; }
    [[nodiscard]] float top() const { return top_; }
    [[nodiscard]] float stature() const { return top_ - floor_; }

    /// All outlines around something solid at height y, largest first.
    [[nodiscard]] std::vector<Outline> at(float y) const;
    /// The outline at height y that carries on `from` of a near level: the one that covers its
    /// middle, else the one whose middle lies nearest. \throw Error when the level is empty
    [[nodiscard]] Outline follow(const Outline& from, float y) const;

  private:
    std::span<const Vec3f> positions_;
    std::vector<Triangle> triangles_; ///< by their lowest corner
    std::vector<float> lows_, highs_; ///< of the triangles
    float tallest_ = 0.0f;            ///< height of the tallest triangle
    float floor_ = 0.0f, top_ = 0.0f;
};

/// Highest level of two outlines that become one, to `precision` metres: `above` is one where they
/// are, `below` one where they are two. `together` tells of a level whether they are.
template <typename Together>
[[nodiscard]] float join_level(float below, float above, float precision,
                               const Together& together) {
    while (above - below > precision) {
        const float middle = 0.5f * (below + above);
        (together(middle) ? above : below) = middle;
    }
    return 0.5f * (below + above);
}

/// The points of two outlines that are nearest to each other.
[[nodiscard]] std::pair<Vec3f, Vec3f> nearest_points(const Outline& a, const Outline& b);

} // namespace toile::body
