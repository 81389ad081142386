// A garment modelled on somebody whose arms and legs stood otherwise, laid into a body's own pose.
#pragma once

#include "body/body_model.h"

#include <span>
#include <string>
#include <vector>

namespace toile::garment {

/// How the body must stand for the garment to sit on it, degrees from its rest pose.
struct PoseMatch {
    float lift = 0.0f;                    ///< of both arms, outwards and up
    float forward = 0.0f;                 ///< of both arms
    float elbow = 0.0f;                   ///< bend of both
    float legs = 0.0f;                    ///< apart
    Vec3f shift = Vec3f::Zero();          ///< of the garment towards that pose, metres
    double before_m = 0.0, after_m = 0.0; ///< mean distance from the skin, inside counting more

    /// The same garment on the body at rest: positions (nv), in place; the linear part of each
    /// vertex's map for its normal: (nv), or empty when nothing moves.
    std::vector<Mat3f> turns;

    [[nodiscard]] bool moved() const { return !turns.empty(); }
    /// "its arms were 24 degrees higher and 6 farther forward: ..."
    [[nodiscard]] std::string text() const;
};

/// Turns both arms and legs of the body until the garment sits closest, and takes the garment back
/// from there to rest: near skin as the skin moves, blended smoothly along the cloth. A garment
/// that sits no better in another pose, or without sleeves or legs, stays as it is. Arms within
/// some 50 degrees of rest, an A or a T. `positions` (nv), as placed on the body at rest; equal
/// places are one vertex. \throw Error when the body cannot be posed
[[nodiscard]] PoseMatch match_pose(const body::BodyModel& body, std::span<const Triangle> triangles,
                                   std::span<Vec3f> positions);

} // namespace toile::garment
