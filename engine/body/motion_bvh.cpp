#include "assets/bvh.h"
#include "body/motion_readers.h"
#include "body/rotations.h"
#include "body/skeleton_tables.h"
#include "core/error.h"

namespace toile::body {

namespace {

using assets::BvhMotion;

/// Joint indices of the file by index of the table.
std::vector<std::size_t> match(const BvhMotion& bvh, const SkeletonTable& table) {
    std::vector<std::size_t> out(table.joints.size());
    for (std::size_t t = 0; t < table.joints.size(); ++t) {
        for (std::size_t j = 0; j < bvh.joints.size(); ++j)
            if (without_prefix(bvh.joints[j].name) == table.joints[t]) out[t] = j;
    }
    return out;
}

/// world_from_joint of every joint of the file in one frame; rest: no rotation at all.
std::vector<RigidTransform> file_pose(const BvhMotion& bvh, std::size_t frame, bool rest) {
    std::vector<RigidTransform> world(bvh.joints.size());
    for (std::size_t j = 0; j < world.size(); ++j) {
        RigidTransform local;
        local.translation = rest ? bvh.joints[j].offset : bvh.translation(frame, j);
        if (!rest) local.rotation = bvh.rotation(frame, j);
        world[j] = bvh.joints[j].parent < 0
                       ? local
                       : world[static_cast<std::size_t>(bvh.joints[j].parent)] * local;
    }
    return world;
}

float leg_length(const Vec3f& hip, const Vec3f& knee, const Vec3f& ankle) {
    return (knee - hip).norm() + (ankle - knee).norm();
}

/// Everything about one file on one skeleton that does not change from frame to frame.
struct Retargeter {
    const BvhMotion& bvh;
    const Skeleton& skeleton;
    const SkeletonTable& table;
    std::vector<std::size_t> joints; ///< of the file, by index of the table
    std::array<Quatf, kJointCount> alignment;
    float scale = 1.0f;

    [[nodiscard]] std::size_t source(Joint joint) const {
        return joints[table.sources[static_cast<std::size_t>(joint)].first];
    }

    void prepare() {
        const auto rest = file_pose(bvh, 0, true);
        std::array<Vec3f, kJointCount> directions;
        directions.fill(Vec3f::Zero());
        for (const Joint joint :
             {Joint::left_upper_arm, Joint::left_lower_arm, Joint::right_upper_arm,
              Joint::right_lower_arm, Joint::left_upper_leg, Joint::left_lower_leg,
              Joint::right_upper_leg, Joint::right_lower_leg}) {
            const auto j = static_cast<std::size_t>(joint);
            directions[j] = unit_or(rest[source(static_cast<Joint>(j + 1))].translation -
                                        rest[source(joint)].translation,
                                    Vec3f::Zero());
        }
        alignment = rest_alignment(skeleton, directions);
        const auto at = [&](Joint joint) { return rest[source(joint)].translation; };
        const float theirs =
            leg_length(at(Joint::left_upper_leg), at(Joint::left_lower_leg), at(Joint::left_foot));
        const float ours =
            leg_length(skeleton.rest(Joint::left_upper_leg), skeleton.rest(Joint::left_lower_leg),
                       skeleton.rest(Joint::left_foot));
        if (!(theirs > 0.0f)) throw Error("its legs have no length");
        scale = ours / theirs;
    }

    [[nodiscard]] Pose pose(std::size_t frame) const {
        const auto theirs = file_pose(bvh, frame, false);
        JointTransforms world;
        for (std::size_t j = 0; j < kJointCount; ++j) {
            const JointBlend& blend = table.sources[j];
            const Quatf a = theirs[joints[blend.first]].rotation;
            const Quatf b = theirs[joints[blend.second]].rotation;
            world[j].rotation = (a.slerp(blend.fraction, b) * alignment[j]).normalized();
        }
        // The middle between the hip joints moves as theirs does.
        const Vec3f middle = 0.5f * (theirs[source(Joint::left_upper_leg)].translation +
                                     theirs[source(Joint::right_upper_leg)].translation);
        const Vec3f rest_middle =
            0.5f * (skeleton.rest(Joint::left_upper_leg) + skeleton.rest(Joint::right_upper_leg));
        world[0].translation =
            scale * middle - world[0].rotation * Vec3f(rest_middle - skeleton.rest(Joint::hips));
        return pose_from_world(world);
    }
};

/// Turns and moves the whole motion: the first pose at the origin facing +Z, feet on the floor.
void place(Motion& motion, const Skeleton& skeleton) {
    const Vec3f facing = motion.poses.front().rotations[0] * Vec3f::UnitZ();
    const Quatf turn = about(Vec3f::UnitY(), -std::atan2(facing.x(), facing.z()));
    const Vec3f start = turn * motion.poses.front().hips_position;
    std::vector<float> heights;
    for (Pose& pose : motion.poses) {
        pose.rotations[0] = (turn * pose.rotations[0]).normalized();
        pose.hips_position = turn * pose.hips_position - Vec3f(start.x(), 0.0f, start.z());
        heights.push_back(lowest_sole(skeleton, forward_kinematics(skeleton, pose)));
    }
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
    std::nth_element(heights.begin(), low, heights.end());
    const float floor = *low;
    for (Pose& pose : motion.poses)
        pose.hips_position.y() -= floor;
}

} // namespace

Motion read_bvh_motion(const std::filesystem::path& file, const Skeleton& skeleton) {
    const BvhMotion bvh = assets::load_bvh(file);
    std::vector<std::string> names;
    for (const auto& joint : bvh.joints)
        names.push_back(joint.name);
    const SkeletonTable* const table = find_table(names);
    if (table == nullptr) {
        throw FileError(file.string(), "joint names of no known system (Mixamo, CMU, or "
                                       "Hips/Ab/Chest with LeftCollar)");
    }
    if (bvh.frame_count == 0) throw FileError(file.string(), "holds no frame");
    if (!(bvh.frame_time_s > 0.0)) throw FileError(file.string(), "frame time is not positive");
    Retargeter retargeter{bvh, skeleton, *table, match(bvh, *table), {}};
    retargeter.prepare();
    Motion motion;
    motion.name = file.stem().string();
    for (std::size_t f = 0; f < bvh.frame_count; ++f) {
        motion.times.push_back(static_cast<double>(f) * bvh.frame_time_s);
        motion.poses.push_back(retargeter.pose(f));
    }
    place(motion, skeleton);
    return motion;
}

} // namespace toile::body
