// Turns the mesh files of one size into its simulation mesh and render scene.
#pragma once

#include "garment/package.h"
#include "garment/package_files.h"

namespace toile::garment {

/// Reads `entry.mesh` (and `entry.render`). Faults go to `faults`; false when the size is of no
/// use for further checks.
bool read_size_meshes(const PackageFiles& files, const SizeEntry& entry, GarmentSize& size,
                      Faults& faults, std::vector<std::string>& notes);

/// The node or its mesh is called `simulation`, in whatever letters.
[[nodiscard]] bool is_simulation(const assets::Scene& scene, const assets::Node& node);

/// World matrix of every node. Skinned meshes stand where their vertices say, whatever the node.
[[nodiscard]] std::vector<Eigen::Affine3f> world_from_node(const assets::Scene& scene);

/// The node's mesh with the node's transform applied to its vertices and normals; without skin
/// and morphs.
[[nodiscard]] assets::Mesh baked_mesh(const assets::Scene& scene, std::size_t node,
                                      const Eigen::Affine3f& world);

/// Adds the baked meshes of `nodes` with their materials, textures and variants to a render scene.
void append_nodes(const assets::Scene& scene, const std::vector<std::size_t>& nodes,
                  assets::Scene& to);

[[nodiscard]] std::vector<std::size_t> nodes_with_meshes(const assets::Scene& scene);

} // namespace toile::garment
