#include "body/test_person.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

constexpr float kFarthestCurve = 0.15f; // of a curve's middle from the plane's point, metres

std::string side_of(Joint joint) {
    const auto name = joint_name(joint);
    return name.starts_with("left") ? ".L" : name.starts_with("right") ? ".R" : "";
}

std::size_t index(Joint joint) {
    return static_cast<std::size_t>(joint);
}

/// Part of a rotation that turns about `axis`; q = swing * twist.
Quatf twist_of(const Quatf& q, const Vec3f& axis) {
    const float along = q.vec().dot(axis);
    const Quatf twist(q.w(), along * axis.x(), along * axis.y(), along * axis.z());
    const float norm = twist.norm();
    if (!(norm > 1e-6f)) return Quatf::Identity(); // half a turn across the axis: no twist
    Quatf unit(twist.coeffs() / norm);
    if (unit.w() < 0.0f) unit.coeffs() = -unit.coeffs();
    return unit;
}

Quatf part_of(const Quatf& q, float share) {
    return Quatf::Identity().slerp(share, q);
}

} // namespace

std::array<std::string, 2> source_bones(Joint joint) {
    const std::string side = side_of(joint);
    const auto one = [&](const char* bone) { return std::array{bone + side, bone + side}; };
    switch (joint) {
    case Joint::hips:
        return one("spine05");
    case Joint::spine:
        return one("spine04");
    case Joint::chest:
        return one("spine02");
    case Joint::upper_chest:
        return one("spine01");
    case Joint::neck:
        return one("neck01");
    case Joint::head:
        return one("head");
    case Joint::left_shoulder:
    case Joint::right_shoulder:
        return one("clavicle");
    case Joint::left_upper_arm:
    case Joint::right_upper_arm:
        return one("upperarm01");
    case Joint::left_lower_arm:
    case Joint::right_lower_arm:
        return one("lowerarm01");
    case Joint::left_hand:
    case Joint::right_hand:
        return one("wrist");
    case Joint::left_upper_leg:
    case Joint::right_upper_leg:
        return one("upperleg01");
    case Joint::left_lower_leg:
    case Joint::right_lower_leg:
        return one("lowerleg01");
    case Joint::left_foot:
    case Joint::right_foot:
        return one("foot");
    default:
        return {"toe1-1" + side, "toe3-1" + side};
    }
}

std::optional<double> girth_in(const GirthPlane& plane, const RigidTransform& moved,
                               std::span<const Vec3f> positions,
                               std::span<const Triangle> triangles) {
    const Vec3f point = moved * plane.point;
    const auto cut = geometry::Plane::through(point, moved.rotation * plane.normal);
    const geometry::Loop* nearest = nullptr;
    float distance = kFarthestCurve;
    const auto loops = geometry::slice(positions, triangles, cut);
    for (const geometry::Loop& loop : loops) {
        const float d = (loop.centroid() - point).norm();
        if (!loop.closed || !(d < distance)) continue;
        distance = d;
        nearest = &loop;
    }
    if (nearest == nullptr) return std::nullopt;
    return geometry::hull_girth(nearest->points, cut);
}

TestPersonPoser::TestPersonPoser(const TestPerson& person)
    : person_(person), drivers_(person.bones.size()), bones_(person.bones.size()),
      positions_(person.rest.positions.size()), eyes_(person.eyes.positions.size()) {
    const auto bone = [&](const std::string& name) {
        const auto found = std::find_if(person.bones.begin(), person.bones.end(),
                                        [&](const TestPersonBone& b) { return b.name == name; });
        if (found == person.bones.end())
            throw Error("test person '" + person.id + "': its rig has no bone '" + name + "'");
        return static_cast<std::size_t>(found - person.bones.begin());
    };
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto names = source_bones(static_cast<Joint>(j));
        heads_[j] = {bone(names[0]), bone(names[1])};
    }
    hips_bone_ = bone("spine05");
    head_bone_ = bone("head");
    const auto drive = [&](const std::string& name, Drive how, Joint joint) -> Driver& {
        Driver& driver = drivers_[bone(name)];
        driver.drive = how;
        driver.joint = joint;
        return driver;
    };
    drive("root", Drive::whole, Joint::hips);
    drive("spine04", Drive::half, Joint::spine);
    drive("spine03", Drive::half, Joint::spine);
    drive("spine02", Drive::whole, Joint::chest);
    drive("spine01", Drive::whole, Joint::upper_chest);
    drive("neck01", Drive::half, Joint::neck);
    drive("neck02", Drive::quarter, Joint::neck);
    drive("neck03", Drive::quarter, Joint::neck);
    drive("head", Drive::whole, Joint::head);

    const auto axis = [&](Joint from, Joint to) {
        return Vec3f((person.skeleton.rest(to) - person.skeleton.rest(from)).normalized());
    };
    const auto limb = [&](const std::string& side, Joint upper, Joint lower, Joint end,
                          const std::array<const char*, 5>& names) {
        drive(names[0] + side, Drive::swing, upper).axis = axis(upper, lower);
        drive(names[1] + side, Drive::twist, upper).axis = axis(upper, lower);
        drive(names[2] + side, Drive::swing, lower).axis = axis(lower, end);
        Driver& fore = drive(names[3] + side, Drive::forearm, lower);
        fore.axis = fore.next_axis = axis(lower, end);
        fore.next = end;
        drive(names[4] + side, Drive::wrist, end).axis = axis(lower, end);
    };
    constexpr std::array<const char*, 5> arm = {"upperarm01", "upperarm02", "lowerarm01",
                                                "lowerarm02", "wrist"};
    constexpr std::array<const char*, 5> leg = {"upperleg01", "upperleg02", "lowerleg01",
                                                "lowerleg02", "foot"};
    limb(".L", Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_hand, arm);
    limb(".R", Joint::right_upper_arm, Joint::right_lower_arm, Joint::right_hand, arm);
    limb(".L", Joint::left_upper_leg, Joint::left_lower_leg, Joint::left_foot, leg);
    limb(".R", Joint::right_upper_leg, Joint::right_lower_leg, Joint::right_foot, leg);
    for (const auto& [side, shoulder, toes] :
         {std::tuple{".L", Joint::left_shoulder, Joint::left_toes},
          std::tuple{".R", Joint::right_shoulder, Joint::right_toes}}) {
        drive(std::string("clavicle") + side, Drive::whole, shoulder);
        for (const char* toe : {"toe1-1", "toe2-1", "toe3-1", "toe4-1", "toe5-1"})
            drive(std::string(toe) + side, Drive::whole, toes);
    }
    pose(rest_pose(person.skeleton));
}

// Half of a limb's twist turns its upper bone, all of it the lower one; half of a hand's or foot's
// twist already turns the bone above it.
Quatf TestPersonPoser::local_rotation(const Driver& driver, const Pose& pose) const noexcept {
    const Quatf& q = pose.rotations[index(driver.joint)];
    switch (driver.drive) {
    case Drive::whole:
        return q;
    case Drive::half:
        return part_of(q, 0.5f);
    case Drive::quarter:
        return part_of(q, 0.25f);
    case Drive::swing:
        return q * part_of(twist_of(q, driver.axis), 0.5f).conjugate();
    case Drive::twist:
        return part_of(twist_of(q, driver.axis), 0.5f);
    case Drive::forearm:
        return part_of(twist_of(q, driver.axis), 0.5f) *
               part_of(twist_of(pose.rotations[index(driver.next)], driver.next_axis), 0.5f);
    case Drive::wrist:
        return part_of(twist_of(q, driver.axis), 0.5f).conjugate() * q;
    default:
        return Quatf::Identity();
    }
}

void TestPersonPoser::pose(const Pose& pose, const RigidTransform& place) noexcept {
    // Bones from the root outwards, then shifted so that the hips are where they should be.
    std::vector<RigidTransform>& bones = bones_;
    for (std::size_t b = 0; b < bones.size(); ++b) {
        const TestPersonBone& bone = person_.bones[b];
        const Quatf local = local_rotation(drivers_[b], pose);
        const RigidTransform turn{local, bone.head - local * bone.head};
        bones[b] = bone.parent < 0 ? turn : bones[static_cast<std::size_t>(bone.parent)] * turn;
        bones[b].rotation.normalize();
    }
    const RigidTransform shift{
        Quatf::Identity(), pose.hips_position - bones[hips_bone_] * person_.bones[hips_bone_].head};
    for (RigidTransform& bone : bones)
        bone = place * (shift * bone);

    JointTransforms plain = forward_kinematics(person_.skeleton, pose); // for the rotations
    for (std::size_t j = 0; j < kJointCount; ++j) {
        joints_[j].rotation = place.rotation * plain[j].rotation;
        joints_[j].translation = 0.5f * (bones[heads_[j][0]] * person_.bones[heads_[j][0]].head +
                                         bones[heads_[j][1]] * person_.bones[heads_[j][1]].head);
    }
    for (std::size_t v = 0; v < positions_.size(); ++v) {
        Vec3f sum = Vec3f::Zero();
        for (const BoneWeight& w : person_.weights[v])
            sum += w.weight * (bones[static_cast<std::size_t>(w.bone)] * person_.rest.positions[v]);
        positions_[v] = sum;
    }
    for (std::size_t v = 0; v < eyes_.size(); ++v)
        eyes_[v] = bones[head_bone_] * person_.eyes.positions[v];
}

RigidTransform TestPersonPoser::moved(Joint joint) const noexcept {
    const RigidTransform& now = joints_[index(joint)];
    return {now.rotation, now.translation - now.rotation * person_.skeleton.rest(joint)};
}

} // namespace toile::body
