#include "body_tracker/other_body.h"

#include "body/motion.h"

namespace toile::body_tracker {

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
