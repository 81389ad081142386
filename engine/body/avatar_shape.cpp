#include "body/avatar_shape.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

constexpr float kMetresPerUnit = 0.1f; // the data is in decimetres
constexpr float kElbowBend = 0.24f;    // radians left at the elbow in our rest pose
constexpr std::size_t kBodyVertices = 13380;

/// Where our joints sit in the rig: the head of a bone. Bones below them follow.
struct JointOfBone {
    const char* bone;
    Joint joint;
};
constexpr std::array<JointOfBone, 30> kJointBones = {{
    {"root", Joint::hips},
    {"spine05", Joint::hips},
    {"spine04", Joint::spine},
    {"spine02", Joint::chest},
    {"spine01", Joint::upper_chest},
    {"neck01", Joint::neck},
    {"head", Joint::head},
    {"clavicle.L", Joint::left_shoulder},
    {"upperarm01.L", Joint::left_upper_arm},
    {"lowerarm01.L", Joint::left_lower_arm},
    {"wrist.L", Joint::left_hand},
    {"clavicle.R", Joint::right_shoulder},
    {"upperarm01.R", Joint::right_upper_arm},
    {"lowerarm01.R", Joint::right_lower_arm},
    {"wrist.R", Joint::right_hand},
    {"upperleg01.L", Joint::left_upper_leg},
    {"lowerleg01.L", Joint::left_lower_leg},
    {"foot.L", Joint::left_foot},
    {"toe1-1.L", Joint::left_toes},
    {"toe3-1.L", Joint::left_toes},
    {"upperleg01.R", Joint::right_upper_leg},
    {"lowerleg01.R", Joint::right_lower_leg},
    {"foot.R", Joint::right_foot},
    {"toe1-1.R", Joint::right_toes},
    {"toe3-1.R", Joint::right_toes},
    {"toe2-1.L", Joint::left_toes},
    {"toe4-1.L", Joint::left_toes},
    {"toe5-1.L", Joint::left_toes},
    {"toe2-1.R", Joint::right_toes},
    {"toe4-1.R", Joint::right_toes},
}};

Vec3f mean(const std::vector<Vec3f>& positions, const std::vector<std::uint32_t>& ids) {
    Vec3f sum = Vec3f::Zero();
    for (const auto id : ids)
        sum += positions[id];
    return sum / static_cast<float>(ids.size());
}

const MakeHumanBone& bone_named(const MakeHumanData& data, const std::string& name) {
    const auto found = std::find_if(data.bones.begin(), data.bones.end(),
                                    [&](const MakeHumanBone& b) { return b.name == name; });
    if (found == data.bones.end()) throw Error(data.source + " has no bone '" + name + "'");
    return *found;
}

/// The forearm's turn about the elbow that leaves `kElbowBend`.
Quatf elbow_turn(const Skeleton& skeleton, Joint upper, Joint lower, Joint hand) {
    const Vec3f elbow = skeleton.rest(lower);
    const Vec3f along = (elbow - skeleton.rest(upper)).normalized();
    const Vec3f fore = (skeleton.rest(hand) - elbow).normalized();
    const Vec3f axis = fore.cross(along);
    const float bend = std::atan2(axis.norm(), fore.dot(along));
    return Quatf(Eigen::AngleAxisf(bend - kElbowBend, axis.normalized()));
}

/// Share of each vertex that moves with `joint` and all below it.
std::vector<float> moved_share(const MakeHumanData& data, Joint joint) {
    const auto joint_of = bone_joints(data);
    std::vector<float> out(data.positions.size(), 0.0f);
    for (std::size_t v = 0; v < out.size(); ++v)
        for (const auto& w : data.weights[v])
            if (descends(joint_of[static_cast<std::size_t>(w.bone)], joint)) out[v] += w.weight;
    return out;
}

/// Turns the forearm and all below about the elbow until `kElbowBend` is left.
void straighten_elbow(const MakeHumanData& data, Joint upper, Joint lower, Joint hand,
                      std::vector<Vec3f>& positions, Skeleton& skeleton) {
    const Vec3f elbow = skeleton.rest(lower);
    const Quatf turn = elbow_turn(skeleton, upper, lower, hand);
    const auto share = moved_share(data, lower);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3f turned = elbow + turn * (positions[v] - elbow);
        positions[v] += share[v] * (turned - positions[v]);
    }
    for (std::size_t j = 0; j < kJointCount; ++j)
        if (descends(static_cast<Joint>(j), lower))
            skeleton.rest_positions[j] = elbow + turn * (skeleton.rest_positions[j] - elbow);
}

} // namespace

bool descends(Joint joint, Joint ancestor) {
    for (std::optional<Joint> j = joint; j; j = joint_parent(*j))
        if (*j == ancestor) return true;
    return false;
}

/// The joint heads in the data's own pose; toes: the ball of the foot, between toes 1 and 3.
Skeleton read_joints(const MakeHumanData& data, const std::vector<Vec3f>& positions) {
    Skeleton out;
    for (const auto& [bone, joint] : kJointBones)
        if (std::string_view(bone) != "root" && std::string_view(bone).substr(0, 3) != "toe")
            out.rest_positions[static_cast<std::size_t>(joint)] =
                mean(positions, bone_named(data, bone).head);
    for (const auto& [side, joint] : {std::pair{".L", Joint::left_toes}, {".R", Joint::right_toes}})
        out.rest_positions[static_cast<std::size_t>(joint)] =
            0.5f * (mean(positions, bone_named(data, std::string("toe1-1") + side).head) +
                    mean(positions, bone_named(data, std::string("toe3-1") + side).head));
    return out;
}

ElbowTurn left_elbow_turn(const MakeHumanData& data, const std::vector<Vec3f>& positions) {
    return {elbow_turn(read_joints(data, positions), Joint::left_upper_arm, Joint::left_lower_arm,
                       Joint::left_hand),
            bone_named(data, "lowerarm01.L").head, moved_share(data, Joint::left_lower_arm)};
}

ShapeRecipe adult_recipe(double woman) {
    ShapeRecipe out;
    for (const auto& [gender, share] : {std::pair{"female", woman}, {"male", 1.0 - woman}}) {
        if (share <= 0.0) continue;
        const std::string g = gender;
        for (const std::string region : {"african", "asian", "caucasian"})
            out["macrodetails/" + region + "-" + g + "-young"] = share / 3.0;
        out["macrodetails/universal-" + g + "-young-averagemuscle-averageweight"] = share;
    }
    return out;
}

std::vector<Joint> bone_joints(const MakeHumanData& data) {
    std::vector<Joint> out;
    for (const auto& bone : data.bones) {
        const auto known = std::find_if(kJointBones.begin(), kJointBones.end(),
                                        [&](const JointOfBone& j) { return bone.name == j.bone; });
        if (known != kJointBones.end())
            out.push_back(known->joint);
        else
            out.push_back(bone.parent < 0 ? Joint::hips
                                          : out[static_cast<std::size_t>(bone.parent)]);
    }
    return out;
}

BaseShape make_base_shape(const MakeHumanData& data, const ShapeRecipe& recipe, double scale) {
    BaseShape out;
    out.positions = data.positions;
    for (const auto& [name, amount] : recipe)
        for (const auto& t : data.target(name))
            out.positions[t.vertex] += static_cast<float>(amount) * t.offset;
    for (auto& p : out.positions)
        p *= kMetresPerUnit * static_cast<float>(scale);
    out.skeleton = read_joints(data, out.positions);
    straighten_elbow(data, Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_hand,
                     out.positions, out.skeleton);
    straighten_elbow(data, Joint::right_upper_arm, Joint::right_lower_arm, Joint::right_hand,
                     out.positions, out.skeleton);

    float floor = std::numeric_limits<float>::max();
    for (std::size_t v = 0; v < kBodyVertices; ++v)
        floor = std::min(floor, out.positions[v].y());
    for (auto& p : out.positions)
        p.y() -= floor;
    for (auto& p : out.skeleton.rest_positions)
        p.y() -= floor;
    return out;
}

} // namespace toile::body
