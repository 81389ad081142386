#include "body_tracker/tracked_shape.h"

#include "body/motion.h"

namespace toile::body_tracker {
namespace {

template <class T>
toile_view view_of(const std::vector<T>& rows, std::uint32_t format) {
    return {rows.data(), static_cast<std::uint32_t>(rows.size()),
            static_cast<std::uint32_t>(sizeof(T)), format, 0};
}

} // namespace

TrackedShape::TrackedShape(const body::FitModel& model, const body::ShapeVector& coefficients,
                           std::uint64_t revision)
    : coefficients_(coefficients.data(), coefficients.data() + coefficients.size()) {
    const body::BodyModel& adult = model.space().model();
    const body::BodyShape shape = body::rest_shape(model, {coefficients, {}});
    rest_ = shape.positions;
    normals_.resize(rest_.size());
    geometry::vertex_normals(rest_, adult.rest.triangles, normals_);
    joints_.assign(shape.skeleton.rest_positions.begin(), shape.skeleton.rest_positions.end());
    for (const auto part : adult.parts)
        parts_.push_back(static_cast<std::uint8_t>(part));
    for (const auto& [name, vertex] : adult.landmarks)
        landmarks_.push_back({name.c_str(), vertex, 0});
    abi_.size = sizeof(abi_);
    abi_.revision = revision;
    abi_.model_id = adult.id.c_str();
    abi_.coefficients = view_of(coefficients_, TOILE_F32);
    abi_.rest.size = sizeof(abi_.rest);
    abi_.rest.positions = view_of(rest_, TOILE_F32X3);
    abi_.rest.normals = view_of(normals_, TOILE_F32X3);
    abi_.rest.triangles = view_of(adult.rest.triangles, TOILE_U32X3);
    abi_.rest.topology_id = 1;
    abi_.rest_joints = view_of(joints_, TOILE_F32X3);
    abi_.joint_indices = view_of(adult.skin.joints, TOILE_U16X4);
    abi_.joint_weights = view_of(adult.skin.weights, TOILE_F32X4);
    abi_.part_labels = view_of(parts_, TOILE_U8);
    abi_.landmarks = view_of(landmarks_, TOILE_STRUCT);
}

body::JointTransforms on_body(const body::Skeleton& other, const body::Skeleton& tracked,
                              const body::JointTransforms& world) noexcept {
    const body::Pose pose = body::pose_from_world(world);
    body::JointTransforms out = body::forward_kinematics(other, pose);
    const float down = body::lowest_sole(tracked, world) - body::lowest_sole(other, out);
    for (RigidTransform& joint : out)
        joint.translation.y() += down;
    return out;
}

} // namespace toile::body_tracker
