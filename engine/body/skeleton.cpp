#include "body/skeleton.h"

namespace toile::body {

namespace {

constexpr std::array<std::string_view, kJointCount> kNames = {
    "hips",          "spine",         "chest",         "upperChest",    "neck",
    "head",          "leftShoulder",  "leftUpperArm",  "leftLowerArm",  "leftHand",
    "rightShoulder", "rightUpperArm", "rightLowerArm", "rightHand",     "leftUpperLeg",
    "leftLowerLeg",  "leftFoot",      "leftToes",      "rightUpperLeg", "rightLowerLeg",
    "rightFoot",     "rightToes"};

constexpr std::uint8_t kNoParent = 255;
constexpr std::array<std::uint8_t, kJointCount> kParents = {
    kNoParent, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

constexpr bool parents_come_first() {
    for (std::size_t i = 1; i < kJointCount; ++i) {
        if (kParents[i] >= i) return false;
    }
    return kParents[0] == kNoParent;
}
static_assert(parents_come_first());

} // namespace

std::string_view joint_name(Joint joint) {
    return kNames[static_cast<std::size_t>(joint)];
}

std::optional<Joint> joint_from_name(std::string_view name) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
        if (kNames[i] == name) return static_cast<Joint>(i);
    }
    return std::nullopt;
}

std::optional<Joint> joint_parent(Joint joint) {
    const std::uint8_t parent = kParents[static_cast<std::size_t>(joint)];
    if (parent == kNoParent) return std::nullopt;
    return static_cast<Joint>(parent);
}

Joint opposite_joint(Joint joint) {
    std::string name(joint_name(joint));
    if (name.starts_with("left"))
        name.replace(0, 4, "right");
    else if (name.starts_with("right"))
        name.replace(0, 5, "left");
    return *joint_from_name(name);
}

Vec3f Skeleton::offset(Joint joint) const {
    const std::uint8_t parent = kParents[static_cast<std::size_t>(joint)];
    if (parent == kNoParent) return rest(joint);
    return rest(joint) - rest_positions[parent];
}

Pose rest_pose(const Skeleton& skeleton) {
    Pose pose;
    pose.hips_position = skeleton.rest(Joint::hips);
    return pose;
}

JointTransforms forward_kinematics(const Skeleton& skeleton, const Pose& pose) noexcept {
    JointTransforms world;
    world[0] = {pose.rotations[0], pose.hips_position};
    for (std::size_t i = 1; i < kJointCount; ++i) {
        const std::size_t parent = kParents[i];
        const Vec3f offset = skeleton.rest_positions[i] - skeleton.rest_positions[parent];
        world[i].translation = world[parent] * offset;
        world[i].rotation = (world[parent].rotation * pose.rotations[i]).normalized();
    }
    return world;
}

JointTransforms skinning_transforms(const Skeleton& skeleton,
                                    const JointTransforms& world) noexcept {
    JointTransforms skinning;
    for (std::size_t i = 0; i < kJointCount; ++i) {
        skinning[i].rotation = world[i].rotation;
        skinning[i].translation =
            world[i].translation - world[i].rotation * skeleton.rest_positions[i];
    }
    return skinning;
}

} // namespace toile::body
