#include "body/pose_training.h"

#include "body/joint_limits.h"
#include "body/skinning.h"
#include "core/bytes.h"
#include "core/parallel.h"
#include "geometry/laplacian.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <mutex>

namespace toile::body {
namespace {

constexpr const char* kReportFile = "training.json";
constexpr std::size_t kMaxReport = 1u << 20;

using FeatureSquare = Eigen::Matrix<double, kPoseFeatures, kPoseFeatures>;

struct Example {
    Pose pose;
    std::vector<Vec3f> relaxed;
};

std::vector<Example> make_examples(const BodyModel& model, const Flesh& flesh, int count,
                                   std::uint64_t seed, const std::function<void()>& done) {
    std::vector<Example> out(static_cast<std::size_t>(count));
    std::mutex guard;
    parallel_for(out.size(), [&](std::size_t i) {
        Random random(Random(seed + i).next());
        out[i].pose = random_pose(model.skeleton, random);
        out[i].relaxed = flesh.relax(
            skinning_transforms(model.skeleton, forward_kinematics(model.skeleton, out[i].pose)));
        const std::lock_guard lock(guard);
        done();
    });
    return out;
}

/// (features x features) inverse of the ridge regression's matrix, for each group of joints in use.
std::map<NearJoints, FeatureSquare> regression_inverses(const std::vector<Pose>& poses,
                                                        const std::vector<NearJoints>& groups,
                                                        double ridge) {
    std::map<NearJoints, FeatureSquare> out;
    for (const auto& group : groups) {
        auto [entry, is_new] = out.emplace(group, FeatureSquare::Zero());
        if (!is_new) continue;
        for (const auto& pose : poses) {
            const auto f = pose_features(rotation_vectors(pose), group).cast<double>().eval();
            entry->second += f * f.transpose();
        }
        // Relative to each feature's own size, so that units do not matter.
        for (int f = 0; f < kPoseFeatures; ++f)
            entry->second(f, f) *= 1.0 + ridge;
        entry->second = entry->second.inverse().eval();
    }
    return out;
}

/// Edges and unit normal of a triangle as columns.
Mat3f frame(std::span<const Vec3f> positions, const Triangle& t) {
    Mat3f out;
    out.col(0) = positions[t[1]] - positions[t[0]];
    out.col(1) = positions[t[2]] - positions[t[0]];
    out.col(2) = out.col(0).cross(out.col(1)).normalized();
    return out;
}

PoseDeformation fit_deformation(const BodyModel& model, const std::vector<Example>& examples,
                                double ridge) {
    const auto& triangles = model.rest.triangles;
    const ScapeModel plain(model, {});
    PoseDeformation out;
    out.joints = nearest_joints(model, triangles);
    out.weights.assign(triangles.size(), Eigen::Matrix<float, 6, kPoseFeatures>::Zero());
    std::vector<Mat3f> rest_inverse;
    rest_inverse.reserve(triangles.size());
    for (const auto& t : triangles)
        rest_inverse.push_back(frame(model.rest.positions, t).inverse());
    std::vector<Quatf> rotations(triangles.size());
    std::vector<Vec3f> places(model.rest.positions.size());
    for (const auto& example : examples) {
        plain.skin(
            skinning_transforms(model.skeleton, forward_kinematics(model.skeleton, example.pose)),
            model.rest.positions, rotations, places);
        const RotationVectors turns = rotation_vectors(example.pose);
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const Mat3f Q = rotations[t].toRotationMatrix().transpose() *
                            frame(example.relaxed, triangles[t]) * rest_inverse[t];
            const Tangents change =
                (Q - Mat3f::Identity()) * tangents(model.rest.positions, triangles[t]);
            out.weights[t] += Eigen::Map<const Eigen::Matrix<float, 6, 1>>(change.data()) *
                              pose_features(turns, out.joints[t]).transpose();
        }
    }
    std::vector<Pose> poses;
    poses.reserve(examples.size());
    for (const auto& example : examples)
        poses.push_back(example.pose);
    const auto inverses = regression_inverses(poses, out.joints, ridge);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        out.weights[t] = out.weights[t] * inverses.at(out.joints[t]).cast<float>();
    return out;
}

/// Vertices as degenerate triangles, so that they find their joints like triangles do.
std::vector<NearJoints> nearest_joints_of_vertices(const BodyModel& model) {
    std::vector<Triangle> points;
    for (std::uint32_t v = 0; v < model.rest.positions.size(); ++v)
        points.push_back({v, v, v});
    return nearest_joints(model, points);
}

/// Correctives that bring plain dual quaternion skinning onto what SCAPE makes of `poses`.
Correctives fit_correctives(const BodyModel& model, const PoseDeformation& deformation,
                            const std::vector<Pose>& poses, double ridge) {
    const std::size_t n = model.rest.positions.size();
    const ScapeModel scape(model, deformation);
    ScapeBody body(scape, {model.rest.positions, model.skeleton});
    std::vector<Vec3f> posed(n);
    Correctives out;
    out.joints = nearest_joints_of_vertices(model);
    out.weights.assign(n, Eigen::Matrix<float, 3, kPoseFeatures>::Zero());
    for (const auto& pose : poses) {
        body.pose(pose, posed);
        const auto motions = to_dual_quaternions(
            skinning_transforms(model.skeleton, forward_kinematics(model.skeleton, pose)));
        const RotationVectors turns = rotation_vectors(pose);
        for (std::size_t v = 0; v < n; ++v) {
            const Vec3f unposed =
                blend(motions, model.skin.joints[v], model.skin.weights[v]).inverse() * posed[v];
            out.weights[v] += (unposed - model.rest.positions[v]) *
                              pose_features(turns, out.joints[v]).transpose();
        }
    }
    const auto inverses = regression_inverses(poses, out.joints, ridge);
    for (std::size_t v = 0; v < n; ++v)
        out.weights[v] = out.weights[v] * inverses.at(out.joints[v]).cast<float>();
    return out;
}

double mean_distance(std::span<const Vec3f> a, std::span<const Vec3f> b,
                     const Eigen::VectorXd& shares) {
    double out = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v)
        out += shares[static_cast<int>(v)] * static_cast<double>((a[v] - b[v]).norm());
    return out;
}

double volume_of(const BodyModel& model, std::span<const Vec3f> positions) {
    return geometry::volume({{positions.begin(), positions.end()}, {}, model.rest.triangles});
}

nlohmann::ordered_json test(const BodyModel& model, const TrainedPose& trained,
                            const std::vector<Example>& tests, std::size_t training_poses) {
    const std::size_t n = model.rest.positions.size();
    const ScapeModel scape(model, trained.tables.deformation);
    ScapeBody body(scape, {model.rest.positions, model.skeleton});
    const CorrectiveSkin baked(body.shape(), model.skin, trained.tables.correctives);
    const SkinnedSurface plain(model.rest.positions, {}, model.skin.joints, model.skin.weights);
    Eigen::VectorXd shares = geometry::lumped_mass(model.rest.positions, model.rest.triangles,
                                                   geometry::MassKind::barycentric);
    shares /= shares.sum();
    const double rest_volume = volume_of(model, model.rest.positions);
    double scape_error = 0.0, linear_error = 0.0, dual_error = 0.0, baked_error = 0.0, apart = 0.0;
    double relaxed_loss = 0.0, linear_loss = 0.0, scape_loss = 0.0;
    std::vector<Vec3f> by_scape(n), by_linear(n), by_dual(n), by_baked(n);
    for (const auto& example : tests) {
        const auto skinning =
            skinning_transforms(model.skeleton, forward_kinematics(model.skeleton, example.pose));
        body.pose(example.pose, by_scape);
        baked.pose(example.pose, by_baked);
        plain.pose(skinning, SkinningMethod::linear_blend, VectorRows(std::span(by_linear)), {});
        plain.pose(skinning, SkinningMethod::dual_quaternion, VectorRows(std::span(by_dual)), {});
        scape_error += mean_distance(by_scape, example.relaxed, shares);
        linear_error += mean_distance(by_linear, example.relaxed, shares);
        dual_error += mean_distance(by_dual, example.relaxed, shares);
        baked_error += mean_distance(by_baked, example.relaxed, shares);
        apart += mean_distance(by_baked, by_scape, shares);
        relaxed_loss += std::abs(1.0 - volume_of(model, example.relaxed) / rest_volume);
        linear_loss += std::abs(1.0 - volume_of(model, by_linear) / rest_volume);
        scape_loss += std::abs(1.0 - volume_of(model, by_scape) / rest_volume);
    }
    const auto mean = [&](double sum, double unit) {
        return std::round(1e3 * unit * sum / static_cast<double>(tests.size())) / 1e3;
    };
    nlohmann::ordered_json out;
    out["training_poses"] = training_poses;
    out["test_poses"] = tests.size();
    out["scape_to_relaxed_mean_mm"] = mean(scape_error, 1e3);
    out["linear_blend_to_relaxed_mean_mm"] = mean(linear_error, 1e3);
    out["dual_quaternion_to_relaxed_mean_mm"] = mean(dual_error, 1e3);
    out["baked_to_relaxed_mean_mm"] = mean(baked_error, 1e3);
    out["scape_share_of_linear_blend_error"] = std::round(1e4 * scape_error / linear_error) / 1e4;
    out["baked_to_scape_mean_mm"] = mean(apart, 1e3);
    out["volume_change_relaxed_percent"] = mean(relaxed_loss, 1e2);
    out["volume_change_scape_percent"] = mean(scape_loss, 1e2);
    out["volume_change_linear_blend_percent"] = mean(linear_loss, 1e2);
    return out;
}

} // namespace

TrainedPose train_pose(const BodyModel& model, const PoseOptions& options) {
    const Flesh flesh(model, options.flesh);
    const int all = options.training_poses + options.test_poses;
    int finished = 0;
    const auto done = [&] { options.progress(static_cast<double>(++finished) / all); };
    const auto examples = make_examples(model, flesh, options.training_poses, options.seed, done);
    const auto tests =
        make_examples(model, flesh, options.test_poses, options.seed + 1000000, done);
    TrainedPose out;
    out.tables.deformation = fit_deformation(model, examples, options.ridge);
    std::vector<Pose> poses;
    poses.reserve(static_cast<std::size_t>(options.baked_poses));
    Random random(options.seed + 2000000);
    for (int i = 0; i < options.baked_poses; ++i)
        poses.push_back(random_pose(model.skeleton, random));
    out.tables.correctives =
        fit_correctives(model, out.tables.deformation, poses, options.baked_ridge);
    out.report = test(model, out, tests, examples.size());
    return out;
}

nlohmann::ordered_json train_pose_tables(const std::filesystem::path& folder,
                                         const PoseOptions& options) {
    const BodyModel model = load_body_model(folder);
    const TrainedPose trained = train_pose(model, options);
    save_pose_tables(trained.tables, model);
    const std::filesystem::path file = folder / kReportFile;
    if (std::filesystem::exists(file)) {
        auto report = nlohmann::ordered_json::parse(read_bytes(file, kMaxReport));
        report["pose"] = trained.report;
        write_text(file, report.dump(2) + "\n");
    }
    return trained.report;
}

} // namespace toile::body
