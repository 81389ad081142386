#include "pipeline/boundary_views.h"

namespace toile::pipeline {
namespace {

using host::view_of;

toile_mesh mesh_view(const geometry::TriangleMesh& mesh, std::span<const Vec2f> corner_coords,
                     std::uint64_t topology_id) {
    auto out = host::sized<toile_mesh>();
    out.positions = view_of(mesh.positions);
    out.normals = view_of(mesh.normals);
    out.triangles = view_of(mesh.triangles);
    out.corner_coords = view_of(corner_coords);
    out.topology_id = topology_id;
    return out;
}

toile_fabric fabric_of(const garment::Fabric& fabric) {
    auto out = host::sized<toile_fabric>();
    out.density_kg_m2 = static_cast<float>(fabric.density_kg_m2);
    out.thickness_m = static_cast<float>(fabric.thickness_m);
    out.stretch_warp_n_m = static_cast<float>(fabric.stretch_warp_n_m);
    out.stretch_weft_n_m = static_cast<float>(fabric.stretch_weft_n_m);
    out.shear_n_m = static_cast<float>(fabric.shear_n_m);
    out.bend_warp_nm = static_cast<float>(fabric.bending_warp_nm);
    out.bend_weft_nm = static_cast<float>(fabric.bending_weft_nm);
    out.friction = static_cast<float>(fabric.friction);
    out.damping = static_cast<float>(fabric.damping);
    return out;
}

} // namespace

BoundaryBody::BoundaryBody(std::shared_ptr<const body::BodyModel> model, std::uint64_t revision)
    : model_(std::move(model)) {
    for (const body::Part part : model_->parts)
        parts_.push_back(static_cast<std::uint8_t>(part));
    for (const auto& [name, vertex] : model_->landmarks)
        landmarks_.push_back({name.c_str(), vertex, 0});
    for (const auto& [name, metres] : model_->measurements)
        measurements_.push_back({name.c_str(), static_cast<float>(metres), 1.0f});

    abi_.size = sizeof(abi_);
    abi_.revision = revision;
    abi_.model_id = model_->id.c_str();
    abi_.coefficients = view_of(std::span<const float>());
    abi_.rest = mesh_view(model_->rest, {}, revision);
    abi_.rest_joints = view_of(model_->skeleton.rest_positions);
    abi_.joint_indices = view_of(model_->skin.joints);
    abi_.joint_weights = view_of(model_->skin.weights);
    abi_.part_labels = view_of(parts_);
    abi_.landmarks = view_of(landmarks_);
    abi_.measurements = view_of(measurements_);
}

BoundaryGarment::BoundaryGarment(std::shared_ptr<const garment::GarmentPackage> package,
                                 const garment::GarmentSize& size,
                                 std::shared_ptr<const BoundaryBody> made_on)
    : package_(std::move(package)), size_(size), made_on_(std::move(made_on)) {
    const garment::Manifest& manifest = package_->manifest;
    abi_.size = sizeof(abi_);
    abi_.layer = manifest.layer;
    abi_.id = manifest.id.c_str();
    abi_.version = manifest.version.c_str();
    abi_.size_name = size_.entry.name.c_str();
    abi_.simulation = mesh_view(size_.simulation, size_.material_coords, 1);
    abi_.joint_indices = view_of(size_.skin.joints);
    abi_.joint_weights = view_of(size_.skin.weights);
    abi_.pins = view_of(package_->pins);
    abi_.made_on = made_on_ ? &made_on_->abi() : nullptr;
    abi_.fabric = fabric_of(manifest.fabric);
    abi_.ease_m = static_cast<float>(manifest.ease_m);
}

} // namespace toile::pipeline
