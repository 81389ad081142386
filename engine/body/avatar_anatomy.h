// What a template vertex belongs to: joints, body part, landmarks.
#pragma once

#include "body/avatar_template.h"
#include "body/body_model.h"

namespace toile::body {

/// The rig's weights on the template: merged to 22 joints, smoothed along the surface so that
/// linear blending bends softly, four largest kept, symmetric. (nv)
/// The body part that a joint moves most of.
[[nodiscard]] Part part_of(Joint joint);

[[nodiscard]] SkinWeights make_skin_weights(const AvatarTemplate& avatar,
                                            const MakeHumanData& data);

/// The part of each vertex: that of the joints that move it most. (nv)
[[nodiscard]] std::vector<Part> make_part_labels(const SkinWeights& weights);

/// Joint positions made symmetric.
[[nodiscard]] Skeleton symmetric(const Skeleton& skeleton);

/// Template vertices of the landmarks (body/landmarks.h) by name, the same for every shape: those
/// nearest to fixed vertices of the base mesh.
[[nodiscard]] std::map<std::string, std::uint32_t> find_landmarks(const AvatarTemplate& avatar);

} // namespace toile::body
