#include "scape_fit/fit_solver.h"

#include "body/rotations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace toile::scape_fit {
namespace {

using body::Joint;
using body::kJointCount;

constexpr std::uint32_t kGrain = 512;
constexpr double kMostTurn = 0.35; // radians and ...
constexpr double kMostShape = 1.5; // ... deviations a step

} // namespace

FitSolver::FitSolver(const FitModel& model)
    : model_(model), pose_prior_(model.space().model().skeleton) {
    for (std::size_t s = 0; s < body::kSexes.size(); ++s) {
        const body::CoefficientPrior& prior = model.space().prior(body::kSexes[s]);
        populations_[s].mean = prior.mean;
        populations_[s].precision = prior.covariance.inverse();
        const Eigen::VectorXd diagonal = prior.covariance.llt().matrixLLT().diagonal();
        populations_[s].log_determinant = 2.0 * diagonal.array().log().sum();
    }
}

double FitSolver::unlikeliness(const ShapeVector& shape, body::Sex sex) const {
    const Population& population = populations_[sex == body::kSexes[0] ? 0 : 1];
    const ShapeVector off = shape - population.mean;
    return off.dot(population.precision * off) + population.log_determinant;
}

int FitSolver::pose_at(std::size_t instant) const {
    return model_.component_count() + kPoseUnknowns * static_cast<int>(instant);
}

int FitSolver::camera_at(const FitState& state, std::size_t camera) const {
    return pose_at(state.poses.size()) + kCameraUnknowns * static_cast<int>(camera);
}

void FitSolver::add_pairs(const FitLevel& level, std::span<const PosedLevel> posed,
                          const AssociatedView& view, const FitState& state, const RowLoop& rows) {
    const auto& pairs = view.association->pairs;
    const int k = model_.component_count();
    const bool has_camera = view.camera < state.cameras.size() && view.eye;
    const int width = k + kPoseUnknowns + (has_camera ? kCameraUnknowns : 0);
    const auto count = static_cast<std::uint32_t>((pairs.size() + kGrain - 1) / kGrain);
    partial_.resize(std::max<std::size_t>(partial_.size(), count));
    const auto information =
        static_cast<float>(1.0 / (kPatchArea * kModelDeviation * kModelDeviation));
    const auto sum_range = [&](std::uint32_t range) {
        const std::size_t begin = std::size_t{range} * kGrain;
        const std::size_t end = std::min(pairs.size(), begin + kGrain);
        ShapeRows block(static_cast<int>(end - begin), width + 1);
        for (std::size_t i = begin; i < end; ++i) {
            const VertexPair& pair = pairs[i];
            const auto at = static_cast<int>(i - begin);
            float* row = block.row(at).data();
            motion_row(model_, level, posed[view.instant], pair.vertex, pair.normal, row);
            if (has_camera) {
                const Vec3f arm = pair.place - *view.eye;
                Eigen::Map<Eigen::Matrix<float, kCameraUnknowns, 1>> camera(row + k +
                                                                            kPoseUnknowns);
                camera << -arm.cross(pair.normal), -pair.normal,
                    pair.kind == PairKind::skin ? -pair.normal.dot(arm) : 0.0f;
            }
            row[width] = pair.distance;
            block.row(at) *= std::sqrt(pair.weight * information);
        }
        partial_[range].setZero(width + 1, width + 1);
        partial_[range].selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
    };
    rows(count, 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t range = begin; range < end; ++range)
            sum_range(range);
    });
    Eigen::MatrixXd total = Eigen::MatrixXd::Zero(width + 1, width + 1);
    for (std::uint32_t range = 0; range < count; ++range)
        total += partial_[range].cast<double>();
    total = Eigen::MatrixXd(total.selfadjointView<Eigen::Lower>());
    // Where the blocks of shape, pose and camera stand among all unknowns.
    const std::array<std::array<int, 3>, 3> parts{
        {{0, 0, k},
         {k, pose_at(view.instant), kPoseUnknowns},
         {k + kPoseUnknowns, has_camera ? camera_at(state, view.camera) : 0,
          has_camera ? kCameraUnknowns : 0}}};
    for (const auto& [from, to, size] : parts) {
        gradient_.segment(to, size) += total.block(from, width, size, 1);
        for (const auto& [from2, to2, size2] : parts)
            normal_.block(to, to2, size, size2) += total.block(from, from2, size, size2);
    }
}

void FitSolver::add_shape_prior(const FitPriors& priors, const FitState& state) {
    const int k = model_.component_count();
    if (priors.sex) {
        const Population& population = populations_[*priors.sex == body::kSexes[0] ? 0 : 1];
        normal_.topLeftCorner(k, k) += priors.shape_weight * population.precision;
        gradient_.head(k) += priors.shape_weight *
                             (population.precision * (state.shape.coefficients - population.mean));
    } else {
        normal_.topLeftCorner(k, k).diagonal().array() += priors.shape_weight;
        gradient_.head(k) += priors.shape_weight * state.shape.coefficients;
    }
}

void FitSolver::add_camera_prior(const FitPriors& priors, const FitState& state) {
    const auto stiffness = [](double deviation) {
        return deviation > 0.0 ? 1.0 / (deviation * deviation) : 1e12;
    };
    for (std::size_t c = 0; c < state.cameras.size(); ++c) {
        const CameraCorrection& camera = state.cameras[c];
        const CameraTrust& trust = c < priors.cameras.size() ? priors.cameras[c] : priors.camera;
        Eigen::Matrix<double, kCameraUnknowns, 1> weight, off;
        weight << Vec3d::Constant(stiffness(trust.turn_rad)),
            Vec3d::Constant(stiffness(trust.shift_m)), stiffness(trust.scale);
        off << camera.turn, camera.shift, camera.scale - 1.0;
        const int at = camera_at(state, c);
        normal_.diagonal().segment<kCameraUnknowns>(at) += weight;
        gradient_.segment<kCameraUnknowns>(at) += weight.cwiseProduct(off);
    }
}

void FitSolver::linearise(const FitLevel& level, std::span<const PosedLevel> posed,
                          std::span<const AssociatedView> views, const FitPriors& priors,
                          const RowLoop& rows, const FitState& state) {
    const int size = camera_at(state, state.cameras.size());
    normal_.setZero(size, size);
    gradient_.setZero(size);
    for (const AssociatedView& view : views)
        add_pairs(level, posed, view, state, rows);
    add_shape_prior(priors, state);
    for (std::size_t f = 0; f < state.poses.size(); ++f)
        pose_prior_.add(state.poses[f], priors.pose_weight, pose_at(f), normal_, gradient_);
    add_camera_prior(priors, state);
}

double FitSolver::step(const FitLevel& level, std::span<const PosedLevel> posed,
                       std::span<const AssociatedView> views, const FitPriors& priors,
                       double damping, const RowLoop& rows, FitState& state) {
    linearise(level, posed, views, priors, rows, state);
    normal_.diagonal() *= 1.0 + damping;
    normal_.diagonal().array() += 1e-6;
    const int k = model_.component_count();
    if (priors.fix_shape) {
        normal_.topRows(k).setZero();
        normal_.leftCols(k).setZero();
        normal_.topLeftCorner(k, k).setIdentity();
        gradient_.head(k).setZero();
    }
    Eigen::VectorXd move = -normal_.ldlt().solve(gradient_);
    double most_turn = 0.0;
    for (std::size_t f = 0; f < state.poses.size(); ++f) {
        auto turns = move.segment(pose_at(f) + 3, kPoseUnknowns - 3);
        const double largest = turns.cwiseAbs().maxCoeff();
        if (largest > kMostTurn) move.segment(pose_at(f), kPoseUnknowns) *= kMostTurn / largest;
        most_turn = std::max(most_turn, std::min(largest, kMostTurn));
    }
    const double reshape = move.head(k).cwiseAbs().maxCoeff();
    if (reshape > kMostShape) move.head(k) *= kMostShape / reshape;
    state.shape.coefficients += move.head(k);
    for (std::size_t f = 0; f < state.poses.size(); ++f)
        state.poses[f] = moved_pose(state.poses[f], move.data() + pose_at(f));
    for (std::size_t c = 0; c < state.cameras.size(); ++c) {
        const double* m = move.data() + camera_at(state, c);
        CameraCorrection& camera = state.cameras[c];
        const Eigen::AngleAxisd turned(rotation_of(Eigen::Map<const Vec3d>(m)) *
                                       rotation_of(camera.turn));
        camera.turn = turned.angle() * turned.axis();
        camera.shift += Eigen::Map<const Vec3d>(m + 3);
        camera.scale *= 1.0 + m[6];
    }
    return most_turn;
}

} // namespace toile::scape_fit
