// The point of a triangle that is nearest to a given one.
#pragma once

#include "core/types.h"

namespace toile::geometry {

/// Where on the triangle the point lies.
enum class Feature { invalid, face, corner0, corner1, corner2, side01, side12, side20 };

struct ClosestPoint {
    Vec3f point;
    Vec3f barycentric; ///< sum 1, none negative
    Feature feature = Feature::invalid;
};

/// Ericson, Real-Time Collision Detection, section 5.1.5. A triangle without area is treated as
/// its sides.
[[nodiscard]] ClosestPoint closest_point(const Vec3f& p, const Vec3f& a, const Vec3f& b,
                                         const Vec3f& c) noexcept;

} // namespace toile::geometry
