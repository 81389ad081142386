// The larger parts of a glTF file, each from tinygltf's form to ours.
#pragma once

#include "assets/gltf_accessor.h"
#include "assets/scene.h"

namespace toile::assets {

/// Fills textures, materials and variants. \throw FileError
void read_gltf_materials(const tinygltf::Model& model, Budget& budget, Scene& scene);

/// `scene` has materials and variants. Points and lines are left out with a warning.
/// \throw FileError
[[nodiscard]] Mesh read_gltf_mesh(const tinygltf::Model& model, const tinygltf::Mesh& mesh,
                                  const Scene& scene, AccessorReader& accessors, Budget& budget);

/// `node_index` maps nodes of the file to those of the scene. \throw FileError
[[nodiscard]] Animation read_gltf_animation(const tinygltf::Animation& animation,
                                            const std::vector<int>& node_index,
                                            AccessorReader& accessors, const Budget& budget);

/// Splits an affine motion into translation, rotation and scale (shear is dropped).
void decompose(const Eigen::Affine3d& transform, Node& node);

} // namespace toile::assets
