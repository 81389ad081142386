#include "mannequin_scan/part_body.h"

#include "core/error.h"

namespace toile::mannequin_scan {
namespace {

using body::SpectralPart;

struct Carrier {
    std::uint8_t label;
    std::uint16_t joint;
};

Carrier carrier_of(SpectralPart part) {
    switch (part) {
    case SpectralPart::abdomen:
        return {TOILE_PART_PELVIS, TOILE_JOINT_SPINE};
    case SpectralPart::left_arm:
        return {TOILE_PART_LEFT_UPPER_ARM, TOILE_JOINT_LEFT_UPPER_ARM};
    case SpectralPart::left_hand:
        return {TOILE_PART_LEFT_LOWER_ARM, TOILE_JOINT_LEFT_LOWER_ARM};
    case SpectralPart::right_arm:
        return {TOILE_PART_RIGHT_UPPER_ARM, TOILE_JOINT_RIGHT_UPPER_ARM};
    case SpectralPart::right_hand:
        return {TOILE_PART_RIGHT_LOWER_ARM, TOILE_JOINT_RIGHT_LOWER_ARM};
    case SpectralPart::left_thigh:
        return {TOILE_PART_LEFT_UPPER_LEG, TOILE_JOINT_LEFT_UPPER_LEG};
    case SpectralPart::left_foot:
        return {TOILE_PART_LEFT_LOWER_LEG, TOILE_JOINT_LEFT_LOWER_LEG};
    case SpectralPart::right_thigh:
        return {TOILE_PART_RIGHT_UPPER_LEG, TOILE_JOINT_RIGHT_UPPER_LEG};
    case SpectralPart::right_foot:
        return {TOILE_PART_RIGHT_LOWER_LEG, TOILE_JOINT_RIGHT_LOWER_LEG};
    default:
        return {TOILE_PART_TORSO, TOILE_JOINT_UPPER_CHEST};
    }
}

template <class T>
toile_view view(const T& rows, std::uint32_t format) {
    return {rows.data(), static_cast<std::uint32_t>(rows.size()),
            static_cast<std::uint32_t>(sizeof(rows[0])), format, 0};
}

} // namespace

PartBody::PartBody(const CleanScan& scan, std::uint64_t revision) {
    if (!scan.parts) throw Error(scan.why_no_parts);
    joints_ = joints_of(scan.clean.mesh, *scan.parts);
    const auto& mesh = scan.clean.mesh;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Carrier held = carrier_of(scan.parts->of[v]);
        if (held.label == TOILE_PART_TORSO && mesh.positions[v].y() > joints_[TOILE_JOINT_HEAD].y())
            held = {TOILE_PART_HEAD, TOILE_JOINT_HEAD};
        labels_.push_back(held.label);
        indices_.push_back({held.joint, 0, 0, 0});
        weights_.push_back({1.0f, 0.0f, 0.0f, 0.0f});
    }
    abi_.size = sizeof(abi_);
    abi_.revision = revision;
    abi_.model_id = "";
    abi_.rest.size = sizeof(abi_.rest);
    abi_.rest.positions = view(mesh.positions, TOILE_F32X3);
    abi_.rest.normals = view(mesh.normals, TOILE_F32X3);
    if (!scan.colors.empty()) abi_.rest.colors = view(scan.colors, TOILE_U8X4);
    abi_.rest.triangles = view(mesh.triangles, TOILE_U32X3);
    abi_.rest.topology_id = revision;
    abi_.rest_joints = view(joints_, TOILE_F32X3);
    abi_.joint_indices = view(indices_, TOILE_U16X4);
    abi_.joint_weights = view(weights_, TOILE_F32X4);
    abi_.part_labels = view(labels_, TOILE_U8);
}

} // namespace toile::mannequin_scan
