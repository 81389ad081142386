// Our own rules for skins, whatever importer they came through.
#pragma once

#include "assets/scene.h"

#include <string>

namespace toile::assets {

/// How strict to be; formats differ in what a row of weights means.
struct SkinRules {
    /// A row of weights may be off 1 by this much and is renormalised; beyond it the file is
    /// refused. Infinity: any positive sum is scaled to 1 (FBX's "normalize" clusters).
    double sum_tolerance = 0.02;
};

/// Holds a scene to the rules: nodes in order without cycles; joints in range, none twice in a
/// skin; inverse bind matrices finite, affine and invertible; every vertex of a skinned primitive
/// has weights that are finite, not negative and sum to 1 (renormalised within the tolerance, and
/// said so at debug level), unused slots at joint 0. \throw FileError
void check_skins(Scene& scene, const std::string& file, const SkinRules& rules = {});

/// One influence of one vertex.
struct Influence {
    std::uint16_t joint = 0;
    float weight = 0.0f;
};

/// Keeps the four largest influences (equal weights: the lower joint first); the kept weights are
/// scaled so that their sum stays what it was. Slots without weight get joint 0.
void keep_four(std::vector<Influence>& influences, std::array<std::uint16_t, 4>& joints,
               std::array<float, 4>& weights);

/// world_from_node of every node, from the nodes' rest transforms.
[[nodiscard]] std::vector<Eigen::Matrix4f> node_transforms(const Scene& scene);

/// Positions of one primitive skinned by `world_from_node` (linear blend), world frame.
[[nodiscard]] std::vector<Vec3f>
skinned_positions(const Primitive& primitive, const Skin& skin,
                  const std::vector<Eigen::Matrix4f>& world_from_node);

} // namespace toile::assets
