// What a template vertex belongs to: joints, body part, named points; and the body's measurements.
#pragma once

#include "body/avatar_template.h"
#include "body/body_model.h"

namespace toile::body {

/// The rig's weights on the template: merged to 22 joints, smoothed along the surface so that
/// linear blending bends softly, four largest kept, symmetric. (nv)
[[nodiscard]] SkinWeights make_skin_weights(const AvatarTemplate& avatar,
                                            const MakeHumanData& data);

/// The part of each vertex: that of the joints that move it most. (nv)
[[nodiscard]] std::vector<Part> make_part_labels(const SkinWeights& weights);

/// Joint positions made symmetric.
[[nodiscard]] Skeleton symmetric(const Skeleton& skeleton);

/// Vertices of named points on one shape: see docs/avatars.md.
[[nodiscard]] std::map<std::string, std::uint32_t> find_landmarks(const AvatarTemplate& avatar,
                                                                  std::span<const Vec3f> positions,
                                                                  const Skeleton& skeleton,
                                                                  std::span<const Part> parts);

/// Tape measurements (convex girths) by ISO 8559-1 names, metres: see docs/avatars.md.
[[nodiscard]] std::map<std::string, double>
measure_avatar(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
               const Skeleton& skeleton, std::span<const Part> parts,
               const std::map<std::string, std::uint32_t>& landmarks);

} // namespace toile::body
