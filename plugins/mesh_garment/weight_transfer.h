// Skin weights for a garment from the body under it.
#pragma once

#include "mesh_garment/body_surface.h"

namespace toile::mesh_garment {

struct TransferOptions {
    float near_m = 0.025f;      ///< at this distance from the skin a match is trusted by 1/e
    float least_cosine = 0.3f;  ///< between garment and body normals; below, no match
    double smooth_m = 0.012;    ///< details of the body's weights below this are lost
    double least_trust = 1e-5;  ///< pull of a vertex without a match towards its nearest weights
    float stretch_bound = 1.6f; ///< wanted of every edge in the test poses
    int relax_rounds = 120;     ///< at most, to reach it
};

/// Weights (nv), four joints each, rows sum to 1. Matches are the nearest surface points whose
/// normal agrees (after Abdrashitov et al. 2023, "Robust skin weights transfer via weight
/// inpainting"); loose parts are filled in smoothly and relaxed until no edge tears in a set of
/// test poses. positions (nv): the garment on this body in its rest pose.
[[nodiscard]] body::SkinWeights transfer_weights(const BodySurface& body,
                                                 std::span<const Vec3f> positions,
                                                 std::span<const Triangle> triangles,
                                                 const TransferOptions& options = {});

/// The poses in which a garment must not tear: strides, a squat, arms forward, up and to the side,
/// a bow, a twist. Maps rest points of each joint into the world.
[[nodiscard]] std::vector<body::JointTransforms>
test_poses(const std::array<Vec3f, body::kJointCount>& joints);

/// Largest posed length / rest length over the edges longer than 4 mm, and over all poses.
[[nodiscard]] float worst_stretch(std::span<const Vec3f> positions,
                                  std::span<const Triangle> triangles,
                                  const body::SkinWeights& weights,
                                  const std::vector<body::JointTransforms>& poses);

} // namespace toile::mesh_garment
