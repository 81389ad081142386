#include "body_tracker/shape_learner.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace toile::body_tracker {
namespace {

constexpr double kNewsOfAFrame = 0.5; // frames of one pose err alike
constexpr double kPosePrior = 4.0;    // 1/rad^2: hardly seen joints must not absorb the shape
constexpr double kUsualWear = 0.02, kMostWear = 0.10; // metres
constexpr int kEvery = 3;
constexpr double kPriorWeight = 1.0; // of the population (P5 eq. 23, whitened)

} // namespace

ShapeLearner::ShapeLearner() {
    const int size = kSurface + body::kPoseUnknowns;
    normal_.resize(size, size);
    gradient_.resize(size);
    reset();
}

void ShapeLearner::reset() noexcept {
    frames_ = passed_ = 0;
    information_ = Eigen::MatrixXd::Zero(kSurface, kSurface);
    value_ = Eigen::VectorXd::Zero(kSurface);
}

bool ShapeLearner::wants() noexcept {
    if (done()) return false;
    if (frames_ >= kFirstFrames && ++passed_ < kEvery) return false;
    passed_ = 0;
    return true;
}

bool ShapeLearner::due() const noexcept {
    return frames_ == 1 || frames_ == 3 || frames_ == 8 || frames_ == kFirstFrames ||
           frames_ == 40 || frames_ == kFrames;
}

void ShapeLearner::add(Registration& registration, const SeenPerson& seen,
                       const RegistrationOptions& options, const body::ShapeVector& shape,
                       const Wear& wear) {
    registration.linearise_shape(seen, options, kShapes, normal_, gradient_);
    constexpr int pose = body::kPoseUnknowns;
    normal_.diagonal().tail(pose).array() += kPosePrior;
    // The pose may move along with the shape: it is eliminated.
    const Eigen::LLT<Eigen::MatrixXd> factor(normal_.bottomRightCorner(pose, pose));
    const Eigen::MatrixXd coupled = factor.solve(normal_.bottomLeftCorner(pose, kSurface));
    const Eigen::MatrixXd information = normal_.topLeftCorner(kSurface, kSurface) -
                                        normal_.topRightCorner(kSurface, pose) * coupled;
    const Eigen::VectorXd gradient =
        gradient_.head(kSurface) - coupled.transpose() * gradient_.tail(pose);
    Eigen::VectorXd now(kSurface);
    now << shape.head(kShapes),
        Eigen::Map<const Eigen::VectorXf>(wear.data(), kWearCount).cast<double>();
    information_ += kNewsOfAFrame * information;
    value_ += kNewsOfAFrame * (information * now - gradient);
    ++frames_;
}

void ShapeLearner::solve(body::ShapeVector& shape, Wear& wear) {
    Eigen::MatrixXd all = information_;
    const Eigen::VectorXd& value = value_;
    all.diagonal().head(kShapes).array() += kPriorWeight;
    all.diagonal().tail(kWearCount).array() += 1.0 / (kUsualWear * kUsualWear);
    Eigen::VectorXd found = all.llt().solve(value);
    // Nothing is worn beneath the skin: what would be is left out, one after the other.
    for (int round = 0; round < kWearCount; ++round) {
        int least = 0;
        if (found.tail(kWearCount).minCoeff(&least) >= 0.0) break;
        all(kShapes + least, kShapes + least) += 1e9;
        found = all.llt().solve(value);
        found[kShapes + least] = 0.0;
    }
    shape.setZero();
    shape.head(kShapes) = found.head(kShapes).cwiseMax(-3.5).cwiseMin(3.5);
    for (int part = 0; part < kWearCount; ++part)
        wear[static_cast<std::size_t>(part)] =
            static_cast<float>(std::clamp(found[kShapes + part], 0.0, kMostWear));
}

} // namespace toile::body_tracker
