#include "body_tracker/parts_labels.h"

#include <algorithm>
#include <array>

namespace toile::body_tracker {
namespace {

using body::Joint;
using body::Part;

struct Row {
    Part p4;
    Joint joint;
};

// In the order of PartLabel.
constexpr std::array<Row, kPartCount + 1> kRows = {{
    {Part::invalid, Joint::hips},
    {Part::head, Joint::head},
    {Part::neck, Joint::neck},
    {Part::torso, Joint::chest},
    {Part::torso, Joint::chest},
    {Part::torso, Joint::spine},
    {Part::torso, Joint::spine},
    {Part::pelvis, Joint::hips},
    {Part::pelvis, Joint::hips},
    {Part::torso, Joint::left_shoulder},
    {Part::torso, Joint::right_shoulder},
    {Part::left_upper_arm, Joint::left_upper_arm},
    {Part::right_upper_arm, Joint::right_upper_arm},
    {Part::left_lower_arm, Joint::left_lower_arm},
    {Part::right_lower_arm, Joint::right_lower_arm},
    {Part::left_lower_arm, Joint::left_hand},
    {Part::right_lower_arm, Joint::right_hand},
    {Part::left_upper_leg, Joint::left_upper_leg},
    {Part::right_upper_leg, Joint::right_upper_leg},
    {Part::left_lower_leg, Joint::left_lower_leg},
    {Part::right_lower_leg, Joint::right_lower_leg},
    {Part::left_lower_leg, Joint::left_foot},
    {Part::right_lower_leg, Joint::right_foot},
}};

const Row& row(PartLabel label) noexcept {
    return kRows[std::min<std::size_t>(static_cast<std::size_t>(label), kPartCount)];
}

PartLabel joint_part(Joint joint, bool left) {
    switch (joint) {
    case Joint::hips:
        return left ? PartLabel::left_pelvis : PartLabel::right_pelvis;
    case Joint::spine:
        return left ? PartLabel::left_belly : PartLabel::right_belly;
    case Joint::chest:
    case Joint::upper_chest:
        return left ? PartLabel::left_chest : PartLabel::right_chest;
    case Joint::neck:
        return PartLabel::neck;
    case Joint::head:
        return PartLabel::head;
    case Joint::left_shoulder:
        return PartLabel::left_shoulder;
    case Joint::right_shoulder:
        return PartLabel::right_shoulder;
    case Joint::left_upper_arm:
        return PartLabel::left_upper_arm;
    case Joint::right_upper_arm:
        return PartLabel::right_upper_arm;
    case Joint::left_lower_arm:
        return PartLabel::left_lower_arm;
    case Joint::right_lower_arm:
        return PartLabel::right_lower_arm;
    case Joint::left_hand:
        return PartLabel::left_hand;
    case Joint::right_hand:
        return PartLabel::right_hand;
    case Joint::left_upper_leg:
        return PartLabel::left_thigh;
    case Joint::right_upper_leg:
        return PartLabel::right_thigh;
    case Joint::left_lower_leg:
        return PartLabel::left_shin;
    case Joint::right_lower_leg:
        return PartLabel::right_shin;
    case Joint::left_foot:
    case Joint::left_toes:
        return PartLabel::left_foot;
    case Joint::right_foot:
    case Joint::right_toes:
        return PartLabel::right_foot;
    }
    return PartLabel::invalid;
}

} // namespace

body::Part p4_part(PartLabel label) noexcept {
    return row(label).p4;
}

body::Joint part_joint(PartLabel label) noexcept {
    return row(label).joint;
}

PartLabel opposite_part(PartLabel label) noexcept {
    if (label <= PartLabel::neck) return label;
    const auto value = static_cast<std::uint8_t>(label);
    return static_cast<PartLabel>(value % 2 == 1 ? value + 1 : value - 1);
}

std::vector<PartLabel> label_vertices(const body::SkinWeights& skin, std::span<const Vec3f> rest) {
    std::vector<PartLabel> labels(rest.size());
    for (std::size_t v = 0; v < labels.size(); ++v) {
        const auto& weights = skin.weights[v];
        const auto heaviest = std::max_element(weights.begin(), weights.end()) - weights.begin();
        const auto joint = static_cast<Joint>(skin.joints[v][static_cast<std::size_t>(heaviest)]);
        labels[v] = joint_part(joint, rest[v].x() >= 0.0f);
    }
    return labels;
}

std::vector<PartLabel> label_vertices(const body::BodyModel& model) {
    return label_vertices(model.skin, model.rest.positions);
}

} // namespace toile::body_tracker
