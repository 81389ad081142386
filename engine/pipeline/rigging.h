// A scan that moves: skeleton and skin weights through the body fitted to it (P2 5.1).
#pragma once

#include "assets/colored_mesh.h"
#include "body/motion.h"
#include "pipeline/body_fit.h"

namespace toile::pipeline {

struct RiggedScan {
    body::Skeleton skeleton;    ///< of the fitted body, at rest
    body::JointTransforms seen; ///< world_from_joint as the scan stands
    body::SkinWeights skin;     ///< (nv of the scan), four joints each
    body::BodyVolumes volumes;  ///< that keep arms out of the trunk in motions
    nlohmann::ordered_json report;
};

/// Weights of `fitted`'s model, taken for each vertex of the scan from the nearest skin of the
/// fitted body that faces the same way, and smoothed along the scan. \throw Error when the model is
/// not at hand
[[nodiscard]] RiggedScan rig_scan(const geometry::TriangleMesh& scan, const FittedBody& fitted);

/// The scan's vertices in another pose.
[[nodiscard]] std::vector<Vec3f> posed(const geometry::TriangleMesh& scan, const RiggedScan& rig,
                                       const body::Pose& pose);

/// The scan as it stands, with a skin over the 22 joints (VRM names), whose nodes' rotations are
/// those of our poses; and the motion, if any, as an animation of 30 frames a second.
[[nodiscard]] assets::Scene rigged_scene(const assets::ColoredMesh& scan, const RiggedScan& rig,
                                         const body::Motion* motion);

} // namespace toile::pipeline
