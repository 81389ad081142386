// A person's shape from the first seconds of tracking (P5 4.1): good frames add what they say
// of the shape and of how far clothes stand off it, whatever the pose was, until enough is known;
// then both are fixed.
#pragma once

#include "body_tracker/registration.h"

namespace toile::body_tracker {

/// Bone lengths do not jump: the shape is given anew a few times, then no more.
class ShapeLearner {
  public:
    static constexpr int kShapes = 12; ///< of the first components

    ShapeLearner();
    void reset() noexcept;
    [[nodiscard]] bool done() const noexcept { return frames_ >= kFrames; }

    /// Is this frame wanted? All of the first ones, then every third: another pose says more.
    [[nodiscard]] bool wants() noexcept;
    /// Adds the frame that `registration` judged last, for the shape it was drawn with.
    void add(Registration& registration, const SeenPerson& seen, const RegistrationOptions& options,
             const body::ShapeVector& shape, const Wear& wear);
    /// Is it time for a new shape?
    [[nodiscard]] bool due() const noexcept;
    /// The likeliest shape so far: whitened components, those beyond kShapes 0; and what is worn.
    void solve(body::ShapeVector& shape, Wear& wear);

  private:
    static constexpr int kFrames = 60, kFirstFrames = 20;
    int frames_ = 0;
    int passed_ = 0; ///< not wanted, in a row
    static constexpr int kSurface = kShapes + kWearCount;
    Eigen::MatrixXd information_; ///< (kSurface x kSurface): shape, then wear
    Eigen::VectorXd value_;       ///< information times shape and wear
    Eigen::MatrixXd normal_;      ///< work space
    Eigen::VectorXd gradient_;
};

} // namespace toile::body_tracker
