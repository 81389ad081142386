#include "pipeline/rigging.h"

#include "assets/skins.h"
#include "body/body_volumes.h"
#include "body/skinning.h"
#include "core/error.h"
#include "geometry/point_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace toile::pipeline {
namespace {

using body::Joint;
using body::kJointCount;
using Row = std::array<float, kJointCount>;

/// The motion that takes the fit's own world to the scan's: both know the surface.
RigidTransform scan_from_fit(const FittedBody& fitted, const body::BodyModel& model) {
    const body::SkinnedSurface skinned(fitted.rest, {}, model.skin.joints, model.skin.weights);
    std::vector<Vec3f> posed(fitted.rest.size());
    const auto world = body::forward_kinematics(fitted.skeleton, fitted.pose);
    skinned.pose(body::skinning_transforms(fitted.skeleton, world),
                 body::SkinningMethod::linear_blend, body::VectorRows(posed), {});
    const auto& seen = fitted.surfaces.front().positions;
    Eigen::Matrix3Xd from(3, posed.size()), to(3, posed.size());
    for (std::size_t v = 0; v < posed.size(); ++v) {
        from.col(static_cast<Eigen::Index>(v)) = posed[v].cast<double>();
        to.col(static_cast<Eigen::Index>(v)) = seen[v].cast<double>();
    }
    const Eigen::Matrix4d move = Eigen::umeyama(from, to, false);
    RigidTransform out;
    out.rotation = Quatf(Mat3f(move.topLeftCorner<3, 3>().cast<float>())).normalized();
    out.translation = move.topRightCorner<3, 1>().cast<float>();
    return out;
}

std::vector<Row> rows_of(const body::SkinWeights& skin) {
    std::vector<Row> out(skin.joints.size(), Row{});
    for (std::size_t v = 0; v < out.size(); ++v)
        for (std::size_t k = 0; k < 4; ++k)
            out[v][skin.joints[v][k]] += skin.weights[v][k];
    return out;
}

/// Of the nearest vertices those that face the vertex's way, the nearer the more.
std::vector<Row> carried(const geometry::TriangleMesh& scan, const geometry::TriangleMesh& body,
                         const std::vector<Row>& rows) {
    constexpr std::size_t kNearest = 12;
    constexpr float kSameWay = 0.2f, kSoft_m = 0.004f;
    const geometry::PointTree tree(body.positions);
    std::vector<Row> out(scan.positions.size(), Row{});
    for (std::size_t v = 0; v < out.size(); ++v) {
        const auto near = tree.nearest(scan.positions[v], kNearest);
        float sum = 0.0f;
        for (const auto& n : near) {
            if (body.normals[n.index].dot(scan.normals[v]) < kSameWay) continue;
            const float weight = 1.0f / (n.squared + kSoft_m * kSoft_m);
            for (std::size_t j = 0; j < kJointCount; ++j)
                out[v][j] += weight * rows[n.index][j];
            sum += weight;
        }
        if (sum == 0.0f)
            out[v] = rows[near.front().index];
        else
            for (float& w : out[v])
                w /= sum;
    }
    return out;
}

void smooth(const geometry::TriangleMesh& scan, std::vector<Row>& rows) {
    constexpr float kWidth_m = 0.02f;
    double length = 0.0;
    for (const auto& t : scan.triangles)
        length += (scan.positions[t[0]] - scan.positions[t[1]]).norm() /
                  static_cast<double>(scan.triangles.size());
    // A round spreads by about an edge times the root of the rounds.
    const int rounds = std::clamp(static_cast<int>(std::pow(kWidth_m / length, 2)), 2, 30);
    const auto around = geometry::vertex_adjacency(scan.positions.size(), scan.triangles);
    std::vector<Row> next(rows.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::uint32_t v = 0; v < rows.size(); ++v) {
            next[v] = rows[v];
            const std::uint32_t count = around.first[v + 1] - around.first[v];
            if (count == 0) continue;
            Row sum{};
            for (std::uint32_t k = around.first[v]; k < around.first[v + 1]; ++k)
                for (std::size_t j = 0; j < kJointCount; ++j)
                    sum[j] += rows[around.neighbours[k]][j];
            for (std::size_t j = 0; j < kJointCount; ++j)
                next[v][j] = 0.5f * (next[v][j] + sum[j] / static_cast<float>(count));
        }
        rows.swap(next);
    }
}

body::SkinWeights four_each(const std::vector<Row>& rows) {
    body::SkinWeights out;
    for (const Row& row : rows) {
        std::vector<assets::Influence> all;
        for (std::size_t j = 0; j < kJointCount; ++j)
            if (row[j] > 1e-4f) all.push_back({static_cast<std::uint16_t>(j), row[j]});
        auto& joints = out.joints.emplace_back();
        auto& weights = out.weights.emplace_back();
        assets::keep_four(all, joints, weights);
        const float sum = weights[0] + weights[1] + weights[2] + weights[3];
        for (float& w : weights)
            w /= sum;
    }
    return out;
}

Mat4f matrix_of(const RigidTransform& t) {
    Mat4f out = Mat4f::Identity();
    out.topLeftCorner<3, 3>() = t.rotation.toRotationMatrix();
    out.topRightCorner<3, 1>() = t.translation;
    return out;
}

assets::Animation animation_of(const body::Motion& motion, int first_node) {
    constexpr double kStep_s = 1.0 / 30.0;
    assets::Animation out;
    out.name = motion.name;
    std::vector<float> times;
    std::vector<body::Pose> poses;
    for (double t = 0.0; t <= motion.duration() + 1e-9; t += kStep_s) {
        times.push_back(static_cast<float>(t));
        poses.push_back(body::sample(motion, t));
    }
    assets::Channel hips{first_node, assets::Channel::Path::translation, times, {}};
    for (const body::Pose& pose : poses)
        hips.values.emplace_back(pose.hips_position.x(), pose.hips_position.y(),
                                 pose.hips_position.z(), 0.0f);
    out.channels.push_back(std::move(hips));
    for (std::size_t j = 0; j < kJointCount; ++j) {
        assets::Channel turn{
            first_node + static_cast<int>(j), assets::Channel::Path::rotation, times, {}};
        for (const body::Pose& pose : poses)
            turn.values.push_back(pose.rotations[j].coeffs());
        out.channels.push_back(std::move(turn));
    }
    return out;
}

} // namespace

RiggedScan rig_scan(const geometry::TriangleMesh& scan, const FittedBody& fitted) {
    const body::BodyModel model = body::load_body_model(body::find_avatar(fitted.model));
    if (model.skin.joints.size() != fitted.rest.size() || fitted.surfaces.empty() ||
        fitted.surfaces.front().positions.size() != fitted.rest.size())
        throw Error("the fitted body is not of the surface of its model " + fitted.model);
    RiggedScan out;
    out.skeleton = fitted.skeleton;
    const RigidTransform move = scan_from_fit(fitted, model);
    out.seen = body::forward_kinematics(fitted.skeleton, fitted.pose);
    for (RigidTransform& joint : out.seen)
        joint = move * joint;
    geometry::TriangleMesh body = fitted.surfaces.front();
    body.normals.resize(body.positions.size());
    geometry::vertex_normals(body.positions, body.triangles, body.normals);
    std::vector<Row> rows = carried(scan, body, rows_of(model.skin));
    smooth(scan, rows);
    out.skin = four_each(rows);
    out.volumes = body::measure_volumes(fitted.skeleton, fitted.rest, model.parts);
    out.report = {{"model", fitted.model}, {"fit", fitted.report}};
    return out;
}

std::vector<Vec3f> posed(const geometry::TriangleMesh& scan, const RiggedScan& rig,
                         const body::Pose& pose) {
    body::JointTransforms move = body::forward_kinematics(rig.skeleton, pose);
    for (std::size_t j = 0; j < kJointCount; ++j)
        move[j] = move[j] * rig.seen[j].inverse();
    const body::SkinnedSurface surface(scan.positions, {}, rig.skin.joints, rig.skin.weights);
    std::vector<Vec3f> out(scan.positions.size());
    surface.pose(move, body::SkinningMethod::dual_quaternion, body::VectorRows(out), {});
    return out;
}

assets::Scene rigged_scene(const assets::ColoredMesh& scan, const RiggedScan& rig,
                           const body::Motion* motion) {
    assets::Scene out = assets::scene_of(scan, "scan");
    assets::Primitive& primitive = out.meshes.front().primitives.front();
    primitive.joints = rig.skin.joints;
    primitive.weights = rig.skin.weights;
    const body::Pose pose = body::pose_from_world(rig.seen);
    const auto first = static_cast<int>(out.nodes.size());
    assets::Skin skin;
    skin.name = "rig";
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto joint = static_cast<Joint>(j);
        const auto parent = body::joint_parent(joint);
        assets::Node node;
        node.name = body::joint_name(joint);
        node.parent = parent ? first + static_cast<int>(*parent) : assets::kNone;
        node.translation = parent ? rig.skeleton.offset(joint) : pose.hips_position;
        node.rotation = pose.rotations[j];
        out.nodes.push_back(node);
        skin.joints.push_back(first + static_cast<int>(j));
        skin.inverse_bind.push_back(matrix_of(rig.seen[j].inverse()));
    }
    out.skins.push_back(std::move(skin));
    out.nodes.front().skin = 0;
    if (motion != nullptr) out.animations.push_back(animation_of(*motion, first));
    return out;
}

} // namespace toile::pipeline
