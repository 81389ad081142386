// What a place on the body means to cloth near it: which parts a garment covers, which places
// belong to one surface, and how two surfaces that come together share what room is left.
#pragma once

#include "cloth/moving_body.h"

namespace toile::cloth {

/// Of a plane as a row n, d: its direction.
[[nodiscard]] inline Vec4 direction(const Vec4& normal) {
    return {normal.x(), normal.y(), normal.z(), 0.0f};
}

/// Joints whose surface runs on from a joint's without a limb between: a walk gets there.
[[nodiscard]] JointMask connected_parts(std::uint8_t joint);
/// Do both joints move one stiff part: the same one, or the trunk?
[[nodiscard]] bool same_part(std::uint8_t a, std::uint8_t b);
/// Joints that move a vertex noticeably, and those next to them.
[[nodiscard]] JointMask covered_parts(const std::array<std::uint16_t, 4>& joints,
                                      const std::array<float, 4>& weights);

/// m, of p over the surface at a place; negative inside.
[[nodiscard]] float signed_distance(const MovingBody& body, const Vec4& p, const SurfacePoint& at);

/// Does the other place push the cloth away from its own? A hand that got beneath a skirt must not
/// carry it off; one over it presses it to the thigh. Cloth far from its own place says nothing.
[[nodiscard]] bool lifts(const MovingBody& body, const SurfacePoint& own,
                         const SurfacePoint& other);

/// Is the other place a part that came against its own so fast that the sample is in it already?
[[nodiscard]] bool faces(const MovingBody& body, const SurfacePoint& own,
                         const SurfacePoint& other);

inline constexpr float kOverRim = 0.9f; ///< cosine, of what lies over a place at the rim of a part
/// Is it where the parts in `allowed` end? What lies beyond is not beneath their skin.
[[nodiscard]] bool on_rim(const MovingBody& body, const SurfacePoint& at, JointMask allowed);

/// m: a sample deeper in a part that it covers came there from the part's other side.
inline constexpr float kThinnest = 0.05f;
/// Half-space that moves with the skin: n.x - d - un t >= offset.
struct SkinPlane {
    Vec4 normal;   ///< and d
    Vec4 velocity; ///< m/s, and its normal part un
};

/// Two surfaces that face each other with less room between them than both offsets take, or none
/// where the body runs into itself: both planes move to the surface midway between them, so that
/// cloth lies there and may slide along it. Planes that lean would press it out of the cleft.
/// Where much is missing it is no neighbour but the far side of a limb, and only the other plane
/// gives way. `at`: the own place; `offset` m. \return whether room was missing
bool share_room(SkinPlane& own, SkinPlane& other, const Vec4& at, float offset);

/// \throw Error when joint rows do not match the vertices, or one is not sound
void check_skin(std::span<const std::array<std::uint16_t, 4>> joints,
                std::span<const std::array<float, 4>> weights, std::size_t vertex_count);

} // namespace toile::cloth
