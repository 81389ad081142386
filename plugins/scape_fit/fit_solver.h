// One Gauss-Newton step of shape, poses and camera corrections.
#pragma once

#include "body/pose_prior.h"
#include "scape_fit/association.h"

#include <optional>
#include <vector>

namespace toile::scape_fit {

inline constexpr int kCameraUnknowns = 7; ///< turn, shift, scale

/// All unknowns of a fit.
struct FitState {
    FitShape shape;
    std::vector<body::Pose> poses;         ///< one for each instant
    std::vector<CameraCorrection> cameras; ///< one for each camera; none for scans
};

/// Standard deviations of what may be wrong with a camera; 0: nothing may.
struct CameraTrust {
    double turn_rad = 0.0;
    double shift_m = 0.0;
    double scale = 0.0;
};

struct FitPriors {
    std::optional<body::Sex> sex; ///< none: all people
    /// Of the shape's prior against the data (P5 eq. 23, in whitened coefficients).
    double shape_weight = 1.0;
    double pose_weight = 1.0;
    bool fix_shape = false;
    CameraTrust camera;
    std::vector<CameraTrust> cameras; ///< of each camera, before `camera`
};

/// What a pair says: all pairs within a patch of this size count as one measurement of this
/// deviation, since what the model cannot show goes together over such patches.
inline constexpr double kPatchArea = 0.01;       // m^2
inline constexpr double kModelDeviation = 0.004; // metres

/// The pairs of one instant seen by one camera.
struct AssociatedView {
    std::size_t instant = 0;
    std::size_t camera = 0;
    std::optional<Vec3f> eye; ///< corrected
    const Association* association = nullptr;
};

/// Not for several threads at once: keeps its work space.
class FitSolver {
  public:
    explicit FitSolver(const FitModel& model);

    /// Moves `state` by one damped step. `posed`: the instants' surfaces in `state`. Returns the
    /// largest move of a joint's angle, radians.
    double step(const FitLevel& level, std::span<const PosedLevel> posed,
                std::span<const AssociatedView> views, const FitPriors& priors, double damping,
                const RowLoop& rows, FitState& state);

    /// What the pairs and priors say around `state`: the unknowns' normal matrix and gradient.
    void linearise(const FitLevel& level, std::span<const PosedLevel> posed,
                   std::span<const AssociatedView> views, const FitPriors& priors,
                   const RowLoop& rows, const FitState& state);
    [[nodiscard]] const Eigen::MatrixXd& normal_matrix() const { return normal_; }
    [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
    /// Of the coefficients' distribution in a sex' population.
    [[nodiscard]] const Eigen::MatrixXd& precision(body::Sex sex) const {
        return populations_[sex == body::kSexes[0] ? 0 : 1].precision;
    }

    /// Minus twice the logarithm of how likely a shape is, for people of a sex.
    [[nodiscard]] double unlikeliness(const ShapeVector& shape, body::Sex sex) const;

  private:
    struct Population {
        ShapeVector mean;
        Eigen::MatrixXd precision;
        double log_determinant = 0.0;
    };
    void add_pairs(const FitLevel& level, std::span<const PosedLevel> posed,
                   const AssociatedView& view, const FitState& state, const RowLoop& rows);
    void add_shape_prior(const FitPriors& priors, const FitState& state);
    void add_camera_prior(const FitPriors& priors, const FitState& state);
    [[nodiscard]] int pose_at(std::size_t instant) const;
    [[nodiscard]] int camera_at(const FitState& state, std::size_t camera) const;

    const FitModel& model_;
    std::array<Population, 2> populations_; ///< in the order of kSexes
    body::PosePrior pose_prior_;
    Eigen::MatrixXd normal_;
    Eigen::VectorXd gradient_;
    std::vector<Eigen::MatrixXf> partial_; ///< per range of pairs: normal matrix and gradient
};

} // namespace toile::scape_fit
