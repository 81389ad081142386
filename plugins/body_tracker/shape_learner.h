// A person's shape from the first seconds of tracking (P5 4.1): each good frame adds what it says
// of the shape, whatever the pose was, until enough is known; then the shape is fixed.
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

    /// Adds the frame that `registration` judged last, for the shape it was drawn with.
    void add(Registration& registration, const SeenPerson& seen, const RegistrationOptions& options,
             const body::ShapeVector& shape);
    /// Is it time for a new shape?
    [[nodiscard]] bool due() const noexcept;
    /// The likeliest shape so far: whitened components, those beyond kShapes 0.
    void solve(body::ShapeVector& shape);

  private:
    static constexpr int kFrames = 60;
    int frames_ = 0;
    Eigen::MatrixXd information_; ///< (kShapes x kShapes)
    Eigen::VectorXd value_;       ///< information times shape
    Eigen::MatrixXd normal_;      ///< work space
    Eigen::VectorXd gradient_;
};

} // namespace toile::body_tracker
