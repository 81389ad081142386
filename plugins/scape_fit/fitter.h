// Fits the body space to what was observed of one person: coarse to fine, robust, with priors.
#pragma once

#include "geometry/slice.h"
#include "scape_fit/fit_solver.h"
#include "scape_fit/free_form.h"
#include "scape_fit/start.h"

#include <functional>

namespace toile::scape_fit {

struct FitOptions {
    std::optional<body::Sex> sex;         ///< none: the likelier one
    double shape_weight = 0.02;           ///< of the prior, see FitPriors
    CameraTrust camera;                   ///< how far cameras may be corrected
    std::vector<CameraTrust> cameras;     ///< the same of each; none: all as `camera`
    std::optional<geometry::Plane> floor; ///< feet that are near it stand on it
    bool dressed = false;                 ///< cloth may lie between skin and points
    ClothGapOptions cloth;                ///< of dressed people
    double dressed_shape_weight = 0.4;    ///< of the prior beneath clothes
    FreeFormOptions dressed_free_form;    ///< beneath clothes
    std::size_t starts = 6;    ///< bodies of the library that are tried; arms anew for no fewer
    bool rough = false;        ///< stop before the finest surface
    bool use_free_form = true; ///< move onto detail that the components cannot show
    FreeFormOptions free_form;
    /// Pairs and detail anew, so often: what is far off the components is reached step by step.
    int detail_rounds = 4;
    std::vector<Vec3f> ups{Vec3f::UnitY()}; ///< directions that may be up
    /// Told how far it is, [0, 1]; true: stop. The fit then throws Cancelled.
    std::function<bool(double)> progress = [](double) { return false; };
};

/// A stationary rig that was calibrated once: what may be off.
inline constexpr CameraTrust kCalibrated{0.0035, 0.005, 0.003};

/// What suits depth pictures of so many cameras (calibrated, when there are several) and instants,
/// and scans.
[[nodiscard]] FitOptions options_for_pictures(std::size_t cameras, std::size_t instants);
[[nodiscard]] FitOptions options_for_scan();

struct Cancelled {};

struct FitResult {
    FitState state;
    body::Sex sex = body::Sex::invalid;
    double rms_m = 0.0;               ///< of the points to the surface, those that have a partner
    double paired_share = 0;          ///< of the points' area
    double seen_share = 0.0;          ///< of the body's area that points stand for
    std::optional<double> skin_share; ///< of a dressed person's points, when colours tell
    int rounds = 0;
};

class Fitter {
  public:
    explicit Fitter(const FitModel& model)
        : model_(model), library_(model), solver_(model), free_form_(model.level(0)) {}

    /// `observations` of one person; instants and cameras are numbered from 0. \throw Error for
    /// no points; Cancelled
    [[nodiscard]] FitResult fit(std::span<const Observation> observations,
                                const FitOptions& options, const RowLoop& rows = &serial_rows);

  private:
    struct Stage;
    class Refinement;
    /// What is fitted: how many instants and cameras, and whether cameras or a scanner saw it.
    struct Scope {
        std::size_t instants = 0, cameras = 0;
        bool depth = false;
    };
    [[nodiscard]] static Scope scope_of(std::span<const Observation> observations);
    void refine(std::span<ObservedPoints> observed, const Stage& stage, const FitOptions& options,
                const RowLoop& rows, FitResult& result);

    [[nodiscard]] FitResult start(std::span<const Observation> observations, const Scope& scope,
                                  const FitOptions& options, const RowLoop& rows);
    [[nodiscard]] FitResult start_instant(std::span<const Observation> seen,
                                          const FitResult& before, const FitOptions& options,
                                          const RowLoop& rows);
    void find_together(std::span<const Observation> observations, const Scope& scope,
                       const FitOptions& options, const RowLoop& rows, FitResult& result);
    void find_detail(std::span<const Observation> observations, const Scope& scope,
                     const FitOptions& options, const RowLoop& rows, FitResult& result);
    void find_beneath(std::span<const Observation> observations, const Scope& scope,
                      const FitOptions& options, const RowLoop& rows, FitResult& result);
    [[nodiscard]] std::optional<double> find_covers(const FitState& state,
                                                    std::vector<Observation>& observations) const;
    [[nodiscard]] std::vector<Observation>
    bare_points(const FitState& state, std::span<const Observation> observations) const;
    void fit_bare(std::span<const Observation> observations, const Scope& scope, FitOptions options,
                  const RowLoop& rows, std::vector<Observation>& bare, FitResult& result);
    void add_poked(std::span<const Observation> observations, const FitState& state,
                   std::vector<Observation>& held) const;
    void retry_arms(std::span<ObservedPoints> observed, const FitOptions& options,
                    const RowLoop& rows, FitResult& best);
    [[nodiscard]] body::Sex likelier_sex(const ShapeVector& shape) const;

    const FitModel& model_;
    StartLibrary library_;
    FitSolver solver_;
    FreeForm free_form_;
};

} // namespace toile::scape_fit
