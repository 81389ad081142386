// How likely a pose is: joints stay near the middle of their ranges, and hardly go past them.
#pragma once

#include "body/skeleton.h"

#include <Eigen/Core>

namespace toile::body {

/// A normal distribution inside each range and a steep wall past its ends, about the axes in which
/// the limits are told (joint_limits.h). Const; allocates nothing.
class PosePrior {
  public:
    explicit PosePrior(const Skeleton& skeleton);

    /// Adds the prior of all joints but the hips to the normal matrix and gradient of a
    /// Gauss-Newton step, linearised at `pose`. The joints' rotation vectors (as moved_pose has
    /// them) stand at `at` + 3 + 3 * joint. `weight` multiplies the range's part, not the wall's.
    void add(const Pose& pose, double weight, int at, Eigen::MatrixXd& normal,
             Eigen::VectorXd& gradient) const noexcept;

  private:
    struct Axis {
        double low = 0.0, high = 0.0, half = 0.0; ///< radians
    };
    std::array<Eigen::Matrix3d, kJointCount> into_axes_; ///< rotation vector to the limits' angles
    std::array<std::array<Axis, 3>, kJointCount> ranges_;
};

} // namespace toile::body
