// One person's head and neck on another's body (P3 eq. 9), without a gap.
#pragma once

#include "assets/colored_mesh.h"

namespace toile::pipeline {

/// A body and where its neck is cut.
struct Necked {
    const assets::ColoredMesh* surface = nullptr; ///< upright, metres
    Vec3f neck = Vec3f::Zero();                   ///< middle of the neck: the cut goes through it
};

/// `body` below its cut, `head` above its own, moved so that the cuts' middles meet; the neck's rim
/// is drawn to the body's over some centimetres, and both are sewn together.
/// \throw Error when a cut meets no neck
[[nodiscard]] assets::ColoredMesh transfer_head(const Necked& body, const Necked& head);

} // namespace toile::pipeline
