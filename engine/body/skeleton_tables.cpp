#include "body/skeleton_tables.h"

#include <algorithm>

namespace toile::body {

namespace {

using Names = std::span<const std::string_view>;

constexpr std::string_view kKinectV1[] = {
    "HipCenter",  "Spine",     "ShoulderCenter", "Head",          "ShoulderLeft",
    "ElbowLeft",  "WristLeft", "HandLeft",       "ShoulderRight", "ElbowRight",
    "WristRight", "HandRight", "HipLeft",        "KneeLeft",      "AnkleLeft",
    "FootLeft",   "HipRight",  "KneeRight",      "AnkleRight",    "FootRight"};

constexpr std::string_view kKinectV2[] = {
    "SpineBase",     "SpineMid",    "Neck",      "Head",          "ShoulderLeft",
    "ElbowLeft",     "WristLeft",   "HandLeft",  "ShoulderRight", "ElbowRight",
    "WristRight",    "HandRight",   "HipLeft",   "KneeLeft",      "AnkleLeft",
    "FootLeft",      "HipRight",    "KneeRight", "AnkleRight",    "FootRight",
    "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight",  "ThumbRight"};

constexpr std::string_view kAzureKinect[] = {
    "PELVIS",        "SPINE_NAVEL",    "SPINE_CHEST",    "NECK",        "CLAVICLE_LEFT",
    "SHOULDER_LEFT", "ELBOW_LEFT",     "WRIST_LEFT",     "HAND_LEFT",   "HANDTIP_LEFT",
    "THUMB_LEFT",    "CLAVICLE_RIGHT", "SHOULDER_RIGHT", "ELBOW_RIGHT", "WRIST_RIGHT",
    "HAND_RIGHT",    "HANDTIP_RIGHT",  "THUMB_RIGHT",    "HIP_LEFT",    "KNEE_LEFT",
    "ANKLE_LEFT",    "FOOT_LEFT",      "HIP_RIGHT",      "KNEE_RIGHT",  "ANKLE_RIGHT",
    "FOOT_RIGHT",    "HEAD",           "NOSE",           "EYE_LEFT",    "EAR_LEFT",
    "EYE_RIGHT",     "EAR_RIGHT"};

constexpr std::string_view kMixamo[] = {
    "Hips",         "Spine",     "Spine1",      "Spine2",      "Neck",          "Head",
    "LeftShoulder", "LeftArm",   "LeftForeArm", "LeftHand",    "RightShoulder", "RightArm",
    "RightForeArm", "RightHand", "LeftUpLeg",   "LeftLeg",     "LeftFoot",      "LeftToeBase",
    "RightUpLeg",   "RightLeg",  "RightFoot",   "RightToeBase"};

// CMU motions as converted for MotionBuilder: LHipJoint, LowerBack, Neck1.
constexpr std::string_view kCmu[] = {
    "Hips",         "LowerBack", "Spine",       "Spine1",      "Neck1",         "Head",
    "LeftShoulder", "LeftArm",   "LeftForeArm", "LeftHand",    "RightShoulder", "RightArm",
    "RightForeArm", "RightHand", "LeftUpLeg",   "LeftLeg",     "LeftFoot",      "LeftToeBase",
    "RightUpLeg",   "RightLeg",  "RightFoot",   "RightToeBase"};

// CMU motions as converted for 3ds Max: lowerback, Chest2, LeftCollar; "LeftShoulder" is the arm.
constexpr std::string_view kCmuCollar[] = {
    "Hips",       "lowerback",    "Chest",      "Chest2",    "Neck",        "Head",
    "LeftCollar", "LeftShoulder", "LeftElbow",  "LeftWrist", "RightCollar", "RightShoulder",
    "RightElbow", "RightWrist",   "LeftHip",    "LeftKnee",  "LeftAnkle",   "LeftToe",
    "RightHip",   "RightKnee",    "RightAnkle", "RightToe"};

// Two joints in the trunk only: Ab and Chest.
constexpr std::string_view kTwoSpine[] = {
    "Hips",         "Ab",         "Chest",     "Neck",        "Head",          "LeftCollar",
    "LeftShoulder", "LeftElbow",  "LeftWrist", "RightCollar", "RightShoulder", "RightElbow",
    "RightWrist",   "LeftHip",    "LeftKnee",  "LeftAnkle",   "LeftToes",      "RightHip",
    "RightKnee",    "RightAnkle", "RightToes"};

/// One row a joint: "ours = first" or "ours = first -> second at fraction".
struct Row {
    Joint ours;
    std::string_view first;
    std::string_view second = {};
    float fraction = 0.0f;
};

SkeletonTable make_table(std::string_view name, Names joints, std::span<const Row> rows) {
    SkeletonTable table{name, joints, {}};
    const auto index = [&](std::string_view joint) {
        return static_cast<std::uint8_t>(std::find(joints.begin(), joints.end(), joint) -
                                         joints.begin());
    };
    for (const Row& row : rows) {
        JointBlend& blend = table.sources[static_cast<std::size_t>(row.ours)];
        blend.first = index(row.first);
        blend.second = row.second.empty() ? blend.first : index(row.second);
        blend.fraction = row.fraction;
    }
    return table;
}

/// A table whose names stand in the order of our joints.
SkeletonTable make_ordered_table(std::string_view name, Names joints) {
    SkeletonTable table{name, joints, {}};
    for (std::size_t i = 0; i < kJointCount; ++i) {
        table.sources[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i), 0.0f};
    }
    return table;
}

using enum Joint;

constexpr Row kKinectV1Rows[] = {
    {hips, "HipCenter"},
    {spine, "HipCenter", "Spine", 0.5f},
    {chest, "Spine", "ShoulderCenter", 0.25f},
    {upper_chest, "Spine", "ShoulderCenter", 0.6f},
    {neck, "ShoulderCenter"},
    {head, "ShoulderCenter", "Head", 0.5f},
    {left_shoulder, "ShoulderCenter", "ShoulderLeft", 0.2f},
    {left_upper_arm, "ShoulderLeft"},
    {left_lower_arm, "ElbowLeft"},
    {left_hand, "WristLeft"},
    {right_shoulder, "ShoulderCenter", "ShoulderRight", 0.2f},
    {right_upper_arm, "ShoulderRight"},
    {right_lower_arm, "ElbowRight"},
    {right_hand, "WristRight"},
    {left_upper_leg, "HipLeft"},
    {left_lower_leg, "KneeLeft"},
    {left_foot, "AnkleLeft"},
    {left_toes, "FootLeft"},
    {right_upper_leg, "HipRight"},
    {right_lower_leg, "KneeRight"},
    {right_foot, "AnkleRight"},
    {right_toes, "FootRight"},
};

constexpr Row kKinectV2Rows[] = {
    {hips, "SpineBase"},
    {spine, "SpineBase", "SpineMid", 0.4f},
    {chest, "SpineMid"},
    {upper_chest, "SpineMid", "SpineShoulder", 0.5f},
    {neck, "Neck"},
    {head, "Neck", "Head", 0.5f},
    {left_shoulder, "SpineShoulder", "ShoulderLeft", 0.2f},
    {left_upper_arm, "ShoulderLeft"},
    {left_lower_arm, "ElbowLeft"},
    {left_hand, "WristLeft"},
    {right_shoulder, "SpineShoulder", "ShoulderRight", 0.2f},
    {right_upper_arm, "ShoulderRight"},
    {right_lower_arm, "ElbowRight"},
    {right_hand, "WristRight"},
    {left_upper_leg, "HipLeft"},
    {left_lower_leg, "KneeLeft"},
    {left_foot, "AnkleLeft"},
    {left_toes, "FootLeft"},
    {right_upper_leg, "HipRight"},
    {right_lower_leg, "KneeRight"},
    {right_foot, "AnkleRight"},
    {right_toes, "FootRight"},
};

constexpr Row kAzureKinectRows[] = {
    {hips, "PELVIS"},
    {spine, "PELVIS", "SPINE_NAVEL", 0.5f},
    {chest, "SPINE_NAVEL"},
    {upper_chest, "SPINE_CHEST"},
    {neck, "NECK"},
    {head, "HEAD"},
    {left_shoulder, "CLAVICLE_LEFT"},
    {left_upper_arm, "SHOULDER_LEFT"},
    {left_lower_arm, "ELBOW_LEFT"},
    {left_hand, "WRIST_LEFT"},
    {right_shoulder, "CLAVICLE_RIGHT"},
    {right_upper_arm, "SHOULDER_RIGHT"},
    {right_lower_arm, "ELBOW_RIGHT"},
    {right_hand, "WRIST_RIGHT"},
    {left_upper_leg, "HIP_LEFT"},
    {left_lower_leg, "KNEE_LEFT"},
    {left_foot, "ANKLE_LEFT"},
    {left_toes, "FOOT_LEFT"},
    {right_upper_leg, "HIP_RIGHT"},
    {right_lower_leg, "KNEE_RIGHT"},
    {right_foot, "ANKLE_RIGHT"},
    {right_toes, "FOOT_RIGHT"},
};

constexpr Row kTwoSpineRows[] = {
    {hips, "Hips"},
    {spine, "Ab"},
    {chest, "Ab", "Chest", 0.5f},
    {upper_chest, "Chest"},
    {neck, "Neck"},
    {head, "Head"},
    {left_shoulder, "LeftCollar"},
    {left_upper_arm, "LeftShoulder"},
    {left_lower_arm, "LeftElbow"},
    {left_hand, "LeftWrist"},
    {right_shoulder, "RightCollar"},
    {right_upper_arm, "RightShoulder"},
    {right_lower_arm, "RightElbow"},
    {right_hand, "RightWrist"},
    {left_upper_leg, "LeftHip"},
    {left_lower_leg, "LeftKnee"},
    {left_foot, "LeftAnkle"},
    {left_toes, "LeftToes"},
    {right_upper_leg, "RightHip"},
    {right_lower_leg, "RightKnee"},
    {right_foot, "RightAnkle"},
    {right_toes, "RightToes"},
};

const SkeletonTable& cmu_table() {
    static const SkeletonTable table = make_ordered_table("cmu", kCmu);
    return table;
}

const SkeletonTable& cmu_collar_table() {
    static const SkeletonTable table = make_ordered_table("cmu_collar", kCmuCollar);
    return table;
}

const SkeletonTable& two_spine_table() {
    static const SkeletonTable table = make_table("two_spine", kTwoSpine, kTwoSpineRows);
    return table;
}

} // namespace

std::optional<std::size_t> SkeletonTable::find(std::string_view joint) const {
    const auto it = std::find(joints.begin(), joints.end(), joint);
    if (it == joints.end()) return std::nullopt;
    return static_cast<std::size_t>(it - joints.begin());
}

const SkeletonTable& kinect_v1_table() {
    static const SkeletonTable table = make_table("kinect_v1", kKinectV1, kKinectV1Rows);
    return table;
}

const SkeletonTable& kinect_v2_table() {
    static const SkeletonTable table = make_table("kinect_v2", kKinectV2, kKinectV2Rows);
    return table;
}

const SkeletonTable& azure_kinect_table() {
    static const SkeletonTable table = make_table("azure_kinect", kAzureKinect, kAzureKinectRows);
    return table;
}

const SkeletonTable& mixamo_table() {
    static const SkeletonTable table = make_ordered_table("mixamo", kMixamo);
    return table;
}

std::string_view without_prefix(std::string_view name) {
    const std::size_t colon = name.rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

const SkeletonTable* find_table(std::span<const std::string> names) {
    // CMU before Mixamo, which shares most of its names.
    for (const SkeletonTable* table :
         {&cmu_table(), &cmu_collar_table(), &mixamo_table(), &two_spine_table()}) {
        const bool all =
            std::all_of(table->joints.begin(), table->joints.end(), [&](std::string_view joint) {
                return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
                    return without_prefix(name) == joint;
                });
            });
        if (all) return table;
    }
    return nullptr;
}

std::vector<const SkeletonTable*> all_tables() {
    return {&kinect_v1_table(), &kinect_v2_table(),  &azure_kinect_table(), &mixamo_table(),
            &cmu_table(),       &cmu_collar_table(), &two_spine_table()};
}

} // namespace toile::body
