// A room with people of the body space in it, drawn without a sensor's errors.
#pragma once

#include "body/joint_limits.h"
#include "body/rotations.h"
#include "body/usual_poses.h"
#include "body_tracker/body_tracking.h"
#include "body_tracker/parts_frames.h"

#include <gtest/gtest.h>

namespace toile::body_tracker {

inline const body::FitModel& adult() {
    static const body::FitModel model(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" /
                                      "adult");
    return model;
}

inline std::shared_ptr<const Forest> shipped_forest() {
    static const auto forest = std::make_shared<const Forest>(load_forest(
        std::filesystem::path(TOILE_SOURCE_DIR) / "plugins" / "body_tracker" / "adult.forest"));
    return forest;
}

/// A camera 1.2 m above the floor at z = 3 m that looks level at a wall at z = -1.5 m.
struct DrawnRoom {
    imaging::Intrinsics camera{320, 240, 290.0, 290.0, 159.5, 119.5, {}};
    Eigen::Isometry3d world_from_camera{Eigen::Translation3d(0.0, 1.2, 3.0)};
    std::vector<float> depth;
    std::vector<body::JointTransforms> people; ///< true joints in the camera's frame

    void clear() {
        people.clear();
        depth.assign(320 * 240, 4.5f);
        for (int y = 120; y < 240; ++y)
            for (int x = 0; x < 320; ++x) {
                const auto floor = static_cast<float>(1.2 * 290.0 / (y - 119.5));
                float& d = depth[static_cast<std::size_t>(y * 320 + x)];
                d = std::min(d, floor);
            }
    }
    /// Stands at x, z (world) with the lowest sole on the floor.
    void add(body::Pose pose, float x, float z, float yaw,
             const body::ShapeVector& shape = body::ShapeVector::Zero(adult().component_count()),
             const Wear& wear = {}) {
        pose.rotations[0] = body::about(Vec3f::UnitY(), yaw) * pose.rotations[0];
        pose.hips_position = Vec3f(x, 0.0f, z);
        body::PosedLevel posed;
        body::pose_level(adult(), adult().level(0), {shape, clothes(wear)}, pose, posed);
        float low = 1e9f;
        for (const Vec3f& p : posed.positions)
            low = std::min(low, p.y());
        const Eigen::Isometry3f from_world = world_from_camera.inverse().cast<float>();
        for (Vec3f& p : posed.positions)
            p = from_world * Vec3f(p.x(), p.y() - low, p.z());
        for (RigidTransform& joint : posed.world)
            joint.translation = from_world * Vec3f(joint.translation - Vec3f(0.0f, low, 0.0f));
        people.push_back(posed.world);
        PartsFrame frame;
        frame.width = 320;
        frame.height = 240;
        frame.focal_px = 290.0f;
        draw_parts(posed.positions, adult().level(0).triangles, labels(), frame);
        for (std::size_t i = 0; i < depth.size(); ++i)
            if (frame.mm[i] != 0) depth[i] = std::min(depth[i], 0.001f * frame.mm[i]);
    }

    /// A box, world.
    void add_box(const Vec3f& low, const Vec3f& high) {
        const Vec3f eye = world_from_camera.translation().cast<float>();
        for (int y = 0; y < 240; ++y)
            for (int x = 0; x < 320; ++x) {
                const Vec3f ray((static_cast<float>(x) - 159.5f) / 290.0f,
                                (119.5f - static_cast<float>(y)) / 290.0f, -1.0f);
                const Vec3f a = (low - eye).cwiseQuotient(ray);
                const Vec3f b = (high - eye).cwiseQuotient(ray);
                const float in = a.cwiseMin(b).maxCoeff(), out = a.cwiseMax(b).minCoeff();
                float& d = depth[static_cast<std::size_t>(y * 320 + x)];
                if (in > 0.0f && in < out) d = std::min(d, in);
            }
    }

  private:
    /// Along the normals of the full surface.
    static std::vector<float> clothes(const Wear& wear) {
        const body::FitLevel& level = adult().level(0);
        std::vector<float> out(level.vertices.size(), 0.0f);
        for (std::size_t v = 0; v < out.size(); ++v)
            for (std::size_t k = 0; k < 4; ++k)
                if (const auto part = wear_of(static_cast<body::Joint>(level.skin.joints[v][k])))
                    out[level.vertices[v]] += level.skin.weights[v][k] * wear[*part];
        return out;
    }
    static const std::vector<PartLabel>& labels() {
        static const std::vector<PartLabel> all = label_vertices(adult().space().model());
        return all;
    }
};

inline std::int64_t frame_time(int frame) {
    return frame * std::int64_t{33'333'333};
}

/// Arms hanging, the left one waving.
inline body::Pose waving(int frame) {
    const body::Skeleton& skeleton = adult().space().model().skeleton;
    body::Pose pose = body::usual_pose(skeleton, body::usual_arms().front(), 0.0f);
    const float t = std::sin(0.1f * static_cast<float>(frame));
    pose.rotations[static_cast<std::size_t>(body::Joint::left_upper_arm)] =
        body::about(Vec3f::UnitZ(), (20.0f + 40.0f * t) * body::kDegree);
    return pose;
}

/// Mean distance of a person's joints from the true ones, metres.
inline float mean_error(const PersonTrack& person, const body::JointTransforms& truth) {
    float sum = 0.0f;
    for (std::size_t j = 0; j < body::kJointCount; ++j)
        sum += (person.joints()[j].translation - truth[j].translation).norm();
    return sum / static_cast<float>(body::kJointCount);
}

} // namespace toile::body_tracker
