#include "body_tracker/bone_distance.h"

#include "body/rotations.h"

#include <algorithm>

namespace toile::body_tracker {
namespace {

using body::Joint;

struct BoneEnds {
    Joint from, to;
    float beyond; ///< how much farther than `to`, in lengths
    float radius_m;
};
constexpr std::array<BoneEnds, 16> kBones{{
    {Joint::hips, Joint::chest, 0.0f, 0.16f},
    {Joint::chest, Joint::neck, 0.0f, 0.16f},
    {Joint::neck, Joint::head, 2.0f, 0.11f},
    {Joint::left_shoulder, Joint::left_upper_arm, 0.0f, 0.08f},
    {Joint::left_upper_arm, Joint::left_lower_arm, 0.0f, 0.06f},
    {Joint::left_lower_arm, Joint::left_hand, 0.6f, 0.05f},
    {Joint::right_shoulder, Joint::right_upper_arm, 0.0f, 0.08f},
    {Joint::right_upper_arm, Joint::right_lower_arm, 0.0f, 0.06f},
    {Joint::right_lower_arm, Joint::right_hand, 0.6f, 0.05f},
    {Joint::hips, Joint::left_upper_leg, 0.0f, 0.12f},
    {Joint::left_upper_leg, Joint::left_lower_leg, 0.0f, 0.09f},
    {Joint::left_lower_leg, Joint::left_foot, 0.0f, 0.07f},
    {Joint::left_foot, Joint::left_toes, 0.6f, 0.06f},
    {Joint::right_upper_leg, Joint::right_lower_leg, 0.0f, 0.09f},
    {Joint::right_lower_leg, Joint::right_foot, 0.0f, 0.07f},
    {Joint::right_foot, Joint::right_toes, 0.6f, 0.06f},
}};

} // namespace

void BoneDistance::set(const body::JointTransforms& joints) noexcept {
    count_ = 0;
    low_ = Vec3f::Constant(1e9f);
    high_ = Vec3f::Constant(-1e9f);
    for (const BoneEnds& ends : kBones) {
        Bone& bone = bones_[count_++];
        bone.from = joints[static_cast<std::size_t>(ends.from)].translation;
        const Vec3f along = (1.0f + ends.beyond) *
                            (joints[static_cast<std::size_t>(ends.to)].translation - bone.from);
        bone.length = along.norm();
        bone.along = body::unit_or(along, Vec3f::UnitY());
        bone.radius = ends.radius_m;
        low_ = low_.cwiseMin(bone.from.cwiseMin(bone.from + along));
        high_ = high_.cwiseMax(bone.from.cwiseMax(bone.from + along));
    }
}

float BoneDistance::operator()(const Vec3f& point) const noexcept {
    const Vec3f outside = (low_ - point).cwiseMax(point - high_).cwiseMax(0.0f);
    if (outside.norm() > 0.6f) return outside.norm();
    float best = 1e9f;
    for (std::size_t k = 0; k < count_; ++k) {
        const Bone& bone = bones_[k];
        const Vec3f off = point - bone.from;
        const float at = std::clamp(off.dot(bone.along), 0.0f, bone.length);
        best = std::min(best, (off - at * bone.along).norm() - bone.radius);
    }
    return best;
}

} // namespace toile::body_tracker
