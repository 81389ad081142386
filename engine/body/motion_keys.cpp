#include "body/leg_solver.h"
#include "body/motion_readers.h"
#include "body/rotations.h"
#include "core/json.h"

namespace toile::body {

namespace {

/// One keyframe: angles in radians about x, then y, then z of the parent, from the base pose.
struct Key {
    double time_s = 0.0;
    Vec3f hips_offset = Vec3f::Zero(); ///< metres from the rest position
    std::array<Vec3f, kJointCount> angles{};
};

struct KeyFile {
    std::string name;
    bool from_rest = false;   ///< base: "rest" or "t_pose"
    bool legs_follow = false; ///< legs: "follow" (planted under the hips) or "keyed"
    double frame_rate = 60.0;
    std::vector<Key> keys;
};

Vec3f vector_of(const std::vector<double>& v, double factor) {
    return (Vec3d(v[0], v[1], v[2]) * factor).cast<float>();
}

std::string choice(JsonObject& object, const std::string& key, const std::string& first,
                   const std::string& second) {
    const std::string value = object.text_or(key, first);
    if (value != first && value != second)
        throw object.error(key, "is '" + value + "', must be '" + first + "' or '" + second + "'");
    return value;
}

Key read_key(JsonObject& object, bool legs_follow) {
    Key key;
    key.angles.fill(Vec3f::Zero());
    key.time_s = object.number("time_s", 0.0, 600.0);
    if (object.has("hips_offset_m"))
        key.hips_offset = vector_of(object.numbers("hips_offset_m", 3), 1.0);
    if (object.has("rotations_deg")) {
        JsonObject rotations = object.object("rotations_deg");
        for (const std::string& name : rotations.keys()) {
            const auto joint = joint_from_name(name);
            if (!joint) throw rotations.error(name, "no such joint; names are those of VRM 1.0");
            const Vec3f angles = vector_of(rotations.numbers(name, 3), std::numbers::pi / 180.0);
            if (angles.cwiseAbs().maxCoeff() > kPi)
                throw rotations.error(name, "angles must be within 180 degrees");
            if (legs_follow && *joint >= Joint::left_upper_leg)
                throw rotations.error(name, "legs follow the hips in this file ('legs')");
            key.angles[static_cast<std::size_t>(*joint)] = angles;
        }
        rotations.finish();
    }
    object.finish();
    return key;
}

KeyFile read_file(const std::filesystem::path& file) {
    const nlohmann::json json = parse_json_file(file);
    JsonObject root(json, file.string());
    KeyFile out;
    (void)root.integer("schema", 1, 1);
    out.name = root.text("name");
    out.from_rest = choice(root, "base", "t_pose", "rest") == "rest";
    out.legs_follow = choice(root, "legs", "keyed", "follow") == "follow";
    out.frame_rate = root.number_or("frame_rate", 1.0, 240.0, 60.0);
    for (JsonObject& object : root.objects("keys")) {
        out.keys.push_back(read_key(object, out.legs_follow));
        const std::size_t n = out.keys.size();
        if (n == 1 && out.keys[0].time_s != 0.0)
            throw object.error("time_s", "the first key must be at 0");
        if (n > 1 && out.keys[n - 1].time_s <= out.keys[n - 2].time_s)
            throw object.error("time_s", "is not after the key before");
    }
    if (out.keys.empty()) throw root.error("keys", "is empty");
    root.finish();
    return out;
}

/// Cubic Hermite with the tangents of Catmull and Rom on uneven keys; flat at both ends.
struct Curve {
    const std::vector<Key>& keys;

    template <class Get>
    [[nodiscard]] Vec3f at(double time, const Get& get) const {
        std::size_t i = 0;
        while (i + 2 < keys.size() && keys[i + 1].time_s <= time)
            ++i;
        if (keys.size() == 1) return get(keys[0]);
        const auto h = static_cast<float>(keys[i + 1].time_s - keys[i].time_s);
        const float t = std::clamp(static_cast<float>(time - keys[i].time_s) / h, 0.0f, 1.0f);
        const Vec3f a = get(keys[i]);
        const Vec3f b = get(keys[i + 1]);
        const Vec3f m0 = h * slope(i, get);
        const Vec3f m1 = h * slope(i + 1, get);
        const float t2 = t * t;
        const float t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * m0 + (-2 * t3 + 3 * t2) * b +
               (t3 - t2) * m1;
    }

  private:
    /// Flat where a value turns round, so that keys are not overshot (Fritsch and Carlson).
    template <class Get>
    [[nodiscard]] Vec3f slope(std::size_t i, const Get& get) const {
        if (i == 0 || i + 1 == keys.size()) return Vec3f::Zero();
        const auto before = static_cast<float>(keys[i].time_s - keys[i - 1].time_s);
        const auto after = static_cast<float>(keys[i + 1].time_s - keys[i].time_s);
        const Vec3f s0 = (get(keys[i]) - get(keys[i - 1])) / before;
        const Vec3f s1 = (get(keys[i + 1]) - get(keys[i])) / after;
        Vec3f out;
        for (Eigen::Index k = 0; k < 3; ++k) {
            const bool turns = s0[k] * s1[k] <= 0.0f;
            out[k] = turns ? 0.0f : 2.0f * s0[k] * s1[k] / (s0[k] + s1[k]);
        }
        return out;
    }
};

Quatf from_angles(const Vec3f& a) {
    return about(Vec3f::UnitZ(), a.z()) * about(Vec3f::UnitY(), a.y()) *
           about(Vec3f::UnitX(), a.x());
}

/// Arms along +-X, legs straight down.
std::array<Vec3f, kJointCount> t_pose_directions() {
    std::array<Vec3f, kJointCount> directions;
    directions.fill(Vec3f::Zero());
    const auto set = [&](Joint joint, const Vec3f& d) {
        directions[static_cast<std::size_t>(joint)] = d;
    };
    set(Joint::left_upper_arm, Vec3f::UnitX());
    set(Joint::left_lower_arm, Vec3f::UnitX());
    set(Joint::right_upper_arm, -Vec3f::UnitX());
    set(Joint::right_lower_arm, -Vec3f::UnitX());
    for (const Joint joint : {Joint::left_upper_leg, Joint::left_lower_leg, Joint::right_upper_leg,
                              Joint::right_lower_leg})
        set(joint, -Vec3f::UnitY());
    return directions;
}

/// The pose of the curves at a time; feet on the floor.
Pose pose_at(const KeyFile& file, double time, const Skeleton& skeleton,
             const std::array<Quatf, kJointCount>& alignment, LegSolver& legs, float dt) {
    const Curve curve{file.keys};
    std::array<Quatf, kJointCount> turned;
    JointTransforms world;
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const Vec3f angles = curve.at(time, [j](const Key& key) { return key.angles[j]; });
        const auto parent = joint_parent(static_cast<Joint>(j));
        turned[j] = from_angles(angles);
        if (parent) turned[j] = turned[static_cast<std::size_t>(*parent)] * turned[j];
        world[j].rotation = (turned[j] * alignment[j]).normalized();
    }
    world[0].translation =
        skeleton.rest(Joint::hips) + curve.at(time, [](const Key& key) { return key.hips_offset; });
    if (file.legs_follow) {
        legs.solve({}, dt, world);
        return pose_from_world(world);
    }
    Pose pose = pose_from_world(world);
    pose.hips_position.y() -= lowest_sole(skeleton, forward_kinematics(skeleton, pose));
    return pose;
}

} // namespace

Motion read_keyframes(const std::filesystem::path& file, const Skeleton& skeleton) {
    const KeyFile keys = read_file(file);
    std::array<Vec3f, kJointCount> none;
    none.fill(Vec3f::Zero());
    const auto alignment = rest_alignment(skeleton, keys.from_rest ? none : t_pose_directions());
    LegSolver legs(skeleton);
    Motion motion;
    motion.name = keys.name;
    const double step = 1.0 / keys.frame_rate;
    const auto frames =
        static_cast<std::size_t>(std::lround(keys.keys.back().time_s * keys.frame_rate)) + 1;
    for (std::size_t f = 0; f < frames; ++f) {
        const double time = static_cast<double>(f) * step;
        motion.times.push_back(time);
        motion.poses.push_back(pose_at(keys, time, skeleton, alignment, legs,
                                       f == 0 ? 0.0f : static_cast<float>(step)));
    }
    return motion;
}

} // namespace toile::body
