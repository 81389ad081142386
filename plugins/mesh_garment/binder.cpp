#include "mesh_garment/binder.h"

#include "core/error.h"
#include "geometry/mesh.h"
#include "mesh_garment/carry.h"

#include <algorithm>

namespace toile::mesh_garment {
namespace {

void check(const GarmentView& garment) {
    const auto report = geometry::check_topology(garment.positions, garment.triangles);
    if (garment.triangles.empty()) throw Error("the garment has no triangles");
    if (!report.usable()) throw Error("the garment's mesh is unfit: " + report.text());
    const std::size_t n = garment.positions.size();
    if (!garment.pins.empty() && garment.pins.size() != n)
        throw Error("the garment's pins are " + std::to_string(garment.pins.size()) + " for " +
                    std::to_string(n) + " vertices");
    if (garment.joint_indices.size() != garment.joint_weights.size() ||
        (!garment.joint_indices.empty() && garment.joint_indices.size() != n))
        throw Error("the garment's skin does not match its vertices");
}

body::SkinWeights weights_of(const BodySurface& body, const GarmentView& garment,
                             std::span<const Vec3f> positions) {
    if (garment.joint_indices.empty()) return transfer_weights(body, positions, garment.triangles);
    return {{garment.joint_indices.begin(), garment.joint_indices.end()},
            {garment.joint_weights.begin(), garment.joint_weights.end()}};
}

} // namespace

Binding bind(const BodySurface& body, const BodySurface* made_on, const GarmentView& garment,
             const Progress& progress) {
    const auto say = [&progress](double fraction, const char* stage) {
        if (progress) progress(fraction, stage);
    };
    check(garment);
    Binding out;
    say(0.0, "moving the garment to the body");
    if (made_on != nullptr && made_on->view().positions.data() != body.view().positions.data())
        out.positions = carry(*made_on, body, garment.positions, garment.triangles);
    else
        out.positions.assign(garment.positions.begin(), garment.positions.end());
    say(0.3, "clearing the body");
    out.clearance = clear_body(body, garment.triangles, garment.ease_m, out.positions);
    say(0.6, "transferring weights");
    out.skin = weights_of(body, garment, out.positions);
    out.attachment.assign(garment.positions.size(), 0.0f);
    std::copy(garment.pins.begin(), garment.pins.end(), out.attachment.begin());
    say(1.0, "bound");
    return out;
}

Targets::Targets(const Binding& binding, const std::array<Vec3f, body::kJointCount>& rest_joints)
    : surface_(binding.positions, {}, binding.skin.joints, binding.skin.weights),
      rest_joints_(rest_joints) {}

void Targets::evaluate(const body::JointTransforms& world_from_joint,
                       body::VectorRows positions) const noexcept {
    body::JointTransforms skinning;
    for (std::size_t j = 0; j < body::kJointCount; ++j)
        skinning[j] = {world_from_joint[j].rotation,
                       world_from_joint[j].translation -
                           world_from_joint[j].rotation * rest_joints_[j]};
    surface_.pose(skinning, body::SkinningMethod::linear_blend, positions, {});
}

} // namespace toile::mesh_garment
