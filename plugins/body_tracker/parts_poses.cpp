#include "body_tracker/parts_poses.h"

#include "body/joint_limits.h"
#include "body/motion.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace toile::body_tracker {
namespace {

using body::Joint;
using body::Pose;

constexpr double kInterval_s = 0.1;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Where an arm is: directions of upper arm and forearm of the left side, in the chest's frame.
struct ArmPlace {
    std::array<float, 3> upper, lower;
};
constexpr std::array<ArmPlace, 12> kArmPlaces = {{
    {{0.12f, -1.0f, 0.0f}, {0.08f, -1.0f, 0.12f}}, // hanging, the commonest: twice
    {{0.25f, -1.0f, -0.05f}, {0.2f, -1.0f, 0.1f}},
    {{1.0f, -0.05f, 0.0f}, {1.0f, 0.0f, 0.05f}},     // out
    {{0.8f, -0.6f, 0.0f}, {0.8f, -0.6f, 0.1f}},      // half out
    {{0.4f, 1.0f, 0.05f}, {0.15f, 1.0f, 0.1f}},      // up
    {{0.1f, -0.15f, 1.0f}, {0.0f, -0.05f, 1.0f}},    // forward
    {{0.65f, -0.75f, -0.3f}, {-0.7f, -0.5f, 0.45f}}, // on the hip
    {{0.25f, -0.9f, 0.45f}, {-0.9f, 0.1f, 0.45f}},   // crossed in front
    {{0.2f, -1.0f, 0.1f}, {0.05f, 0.0f, 1.0f}},      // forearm forward
    {{0.3f, -0.9f, 0.2f}, {0.1f, 0.8f, 0.6f}},       // forearm raised
    {{0.8f, 0.45f, 0.3f}, {-0.6f, 0.7f, 0.0f}},      // at the head
    {{0.35f, -0.85f, -0.45f}, {-0.7f, -0.4f, -0.5f}} // behind the back
}};
constexpr double kArmSpread = 0.15; // deviation of each coordinate of a direction

Vec3f jittered(const std::array<float, 3>& direction, bool left, Random& random) {
    Vec3f out(left ? direction[0] : -direction[0], direction[1], direction[2]);
    for (float& value : out)
        value += static_cast<float>(kArmSpread * random.normal());
    return out.normalized();
}

Quatf turn(double sigma_rad, Random& random) {
    Vec3f v;
    for (float& value : v)
        value = static_cast<float>(sigma_rad * random.normal());
    const float angle = v.norm();
    return angle > 0.0f ? Quatf(Eigen::AngleAxisf(angle, v / angle)) : Quatf::Identity();
}

/// Faces +Z.
Pose turned_ahead(Pose pose) {
    const Vec3f ahead = pose.rotations[0] * Vec3f::UnitZ();
    const float yaw = std::atan2(ahead.x(), ahead.z());
    pose.rotations[0] = Quatf(Eigen::AngleAxisf(-yaw, Vec3f::UnitY())) * pose.rotations[0];
    return pose;
}

void place_arm(const body::Skeleton& skeleton, bool left, const ArmPlace& place, Random& random,
               Pose& pose) {
    const auto joint = [&](Joint of_left) {
        return static_cast<std::size_t>(left ? of_left : body::opposite_joint(of_left));
    };
    const std::size_t shoulder = joint(Joint::left_shoulder), upper = joint(Joint::left_upper_arm),
                      lower = joint(Joint::left_lower_arm), hand = joint(Joint::left_hand);
    const Vec3f upper_rest = skeleton.rest_positions[lower] - skeleton.rest_positions[upper];
    const Vec3f lower_rest = skeleton.rest_positions[hand] - skeleton.rest_positions[lower];
    const Quatf upper_turn = Quatf::FromTwoVectors(upper_rest, jittered(place.upper, left, random));
    const Quatf lower_turn =
        Quatf::FromTwoVectors(upper_turn * lower_rest, jittered(place.lower, left, random));
    pose.rotations[upper] = pose.rotations[shoulder].conjugate() * upper_turn;
    pose.rotations[lower] = upper_turn.conjugate() * lower_turn * upper_turn;
}

std::vector<std::filesystem::path> motion_files(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<std::filesystem::path> out;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
        const auto extension = entry.path().extension();
        if (extension == ".bvh" || extension == ".jsonl" || extension == ".json")
            out.push_back(entry.path());
    }
    if (out.empty())
        throw Error(path.string() + ": no motion in this folder (.bvh, .jsonl or .json)");
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace

std::vector<Pose> read_poses(std::span<const std::filesystem::path> paths,
                             const body::Skeleton& skeleton) {
    std::vector<Pose> out;
    for (const auto& path : paths)
        for (const auto& file : motion_files(path)) {
            const body::Motion motion = body::load_motion(file, skeleton);
            for (int k = 0; k * kInterval_s <= motion.duration(); ++k)
                out.push_back(turned_ahead(body::sample(motion, k * kInterval_s)));
        }
    return out;
}

Pose perturbed(const Pose& pose, double sigma_rad, Random& random) {
    Pose out = pose;
    for (std::size_t j = 1; j < body::kJointCount; ++j)
        out.rotations[j] = (pose.rotations[j] * turn(sigma_rad, random)).normalized();
    return out;
}

Pose standing_pose(const body::Skeleton& skeleton, Random& random) {
    Pose pose = perturbed(body::rest_pose(skeleton), 4.0 * kDegree, random);
    pose.rotations[0] = turn(4.0 * kDegree, random);
    const auto set = [&](Joint left, const Quatf& l, const Quatf& r) {
        pose.rotations[static_cast<std::size_t>(left)] *= l;
        pose.rotations[static_cast<std::size_t>(body::opposite_joint(left))] *= r;
    };
    // Legs from closed to apart, now and then a knee bent or a step.
    const auto about = [&](const Vec3f& axis, double radians) {
        return Quatf(Eigen::AngleAxisf(static_cast<float>(radians), axis));
    };
    const double apart = random.uniform(-3.0, 12.0) * kDegree;
    const double step = random.uniform() < 0.3 ? random.uniform(-25.0, 25.0) * kDegree : 0.0;
    set(Joint::left_upper_leg, about(Vec3f::UnitZ(), apart) * about(Vec3f::UnitX(), -step),
        about(Vec3f::UnitZ(), -apart) * about(Vec3f::UnitX(), step));
    const auto knee = [&] {
        return about(Vec3f::UnitX(),
                     random.uniform() < 0.2 ? random.uniform(0.0, 60.0) * kDegree : 0.0);
    };
    const Quatf left_knee = knee();
    set(Joint::left_lower_leg, left_knee, knee());

    const auto place = [&] { return random.next() % kArmPlaces.size(); };
    const std::size_t left = place();
    const std::size_t right = random.uniform() < 0.5 ? left : place();
    place_arm(skeleton, true, kArmPlaces[left], random, pose);
    place_arm(skeleton, false, kArmPlaces[right], random, pose);
    return pose;
}

Pose draw_pose(const body::Skeleton& skeleton, std::span<const Pose> recorded, const PoseMix& mix,
               Random& random) {
    const double kind = random.uniform();
    if (recorded.empty())
        return kind < 0.5 ? standing_pose(skeleton, random) : body::random_pose(skeleton, random);
    if (kind >= mix.recorded + mix.standing) return body::random_pose(skeleton, random);
    if (kind >= mix.recorded) return standing_pose(skeleton, random);
    Pose pose = recorded[random.next() % recorded.size()];
    if (random.next() % 2 == 0) pose = body::mirrored(pose);
    return perturbed(pose, mix.turned * random.uniform(5.0, 15.0) * kDegree, random);
}

} // namespace toile::body_tracker
