// A body made ready for measuring: its landmarks, its parts, and which way they stand.
#pragma once

#include "body/landmarks.h"
#include "core/types.h"
#include "geometry/tape.h"

#include <array>
#include <span>
#include <vector>

namespace toile::body {

/// What a tape may lie on.
enum class Region : std::uint8_t {
    trunk, ///< neck, torso, pelvis and thighs, without the arms
    head,  ///< and the neck
    left_arm,
    right_arm, ///< and the hand
    left_leg,
    right_leg, ///< and the foot
};
inline constexpr std::size_t kRegionCount = 6;
using Regions = std::array<geometry::SurfacePart, kRegionCount>;

/// Centres of the joints of one limb.
struct Limb {
    Vec3f root;   ///< shoulder or hip
    Vec3f middle; ///< elbow or knee
    Vec3f end;    ///< wrist or ankle
    Vec3f tip;    ///< middle of the hand, ball of the foot
};

/// Which way a part of the trunk stands; unit vectors.
struct Axes {
    Vec3f up = Vec3f::UnitY(); ///< along the spine
    Vec3f forward = Vec3f::UnitZ();
    Vec3f left = Vec3f::UnitX(); ///< the person's
};

/// Found on a body of a model (body/measurer.h). World
/// frame, metres. Borrows the surface.
struct Figure {
    std::span<const Vec3f> positions;    ///< (nv)
    std::span<const Triangle> triangles; ///< (nf) the whole surface
    const Regions* regions = nullptr;
    std::array<Vec3f, kLandmarkCount> landmarks;
    std::array<double, kLandmarkCount> landmark_trust; ///< [0, 1]: how well each was found
    std::array<double, kRegionCount> region_trust;     ///< [0, 1]: how well its tapes can lie
    double standing = 1.0; ///< [0, 1]: how far heights above the floor mean what they say

    Vec3f up = Vec3f::UnitY();      ///< against gravity
    Axes hips, waist, chest;        ///< across their `up` the trunk's girths lie
    Vec3f neck_up = Vec3f::UnitY(); ///< along the neck
    Limb right_arm, right_leg;      ///< tapes of limbs are laid on the right, as by ISO 8559-1

    [[nodiscard]] const geometry::SurfacePart& region(Region r) const {
        return (*regions)[static_cast<std::size_t>(r)];
    }
};

} // namespace toile::body
