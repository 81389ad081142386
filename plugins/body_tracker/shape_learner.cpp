#include "body_tracker/shape_learner.h"

#include <Eigen/Cholesky>

namespace toile::body_tracker {
namespace {

constexpr double kNewsOfAFrame = 0.5; // frames of one pose err alike
constexpr double kPosePrior = 4.0;    // 1/rad^2: hardly seen joints must not absorb the shape
constexpr double kPriorWeight = 1.0;  // of the population (P5 eq. 23, whitened)

} // namespace

ShapeLearner::ShapeLearner() {
    const int size = kShapes + body::kPoseUnknowns;
    normal_.resize(size, size);
    gradient_.resize(size);
    reset();
}

void ShapeLearner::reset() noexcept {
    frames_ = 0;
    information_ = Eigen::MatrixXd::Zero(kShapes, kShapes);
    value_ = Eigen::VectorXd::Zero(kShapes);
}

bool ShapeLearner::due() const noexcept {
    return frames_ == 1 || frames_ == 3 || frames_ == 8 || frames_ == 20 || frames_ == kFrames;
}

void ShapeLearner::add(Registration& registration, const SeenPerson& seen,
                       const RegistrationOptions& options, const body::ShapeVector& shape) {
    registration.linearise_shape(seen, options, kShapes, normal_, gradient_);
    constexpr int pose = body::kPoseUnknowns;
    normal_.diagonal().tail(pose).array() += kPosePrior;
    // The pose may move along with the shape: it is eliminated.
    const Eigen::LLT<Eigen::MatrixXd> factor(normal_.bottomRightCorner(pose, pose));
    const Eigen::MatrixXd coupled = factor.solve(normal_.bottomLeftCorner(pose, kShapes));
    const Eigen::MatrixXd information =
        normal_.topLeftCorner(kShapes, kShapes) - normal_.topRightCorner(kShapes, pose) * coupled;
    const Eigen::VectorXd gradient =
        gradient_.head(kShapes) - coupled.transpose() * gradient_.tail(pose);
    information_ += kNewsOfAFrame * information;
    value_ += kNewsOfAFrame * (information * shape.head(kShapes) - gradient);
    ++frames_;
}

void ShapeLearner::solve(body::ShapeVector& shape) {
    const Eigen::MatrixXd all =
        information_ + kPriorWeight * Eigen::MatrixXd::Identity(kShapes, kShapes);
    const Eigen::VectorXd found = all.llt().solve(value_);
    shape.setZero();
    shape.head(kShapes) = found.cwiseMax(-3.5).cwiseMin(3.5);
}

} // namespace toile::body_tracker
