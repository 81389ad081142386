// Tracked people on a body that was given instead of found.
#pragma once

#include "body/skeleton.h"

namespace toile::body_tracker {

/// The pose on another body: the same turns, bones of its own length, soles as high as before.
[[nodiscard]] body::JointTransforms on_body(const body::Skeleton& other,
                                            const body::Skeleton& tracked,
                                            const body::JointTransforms& world) noexcept;

} // namespace toile::body_tracker
