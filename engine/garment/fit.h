// How worn garments fit: what fit.json holds (docs/fit.md says what the numbers mean).
#pragma once

#include "body/measurer.h"
#include "garment/cloth_strain.h"
#include "garment/contact_metrics.h"
#include "garment/ease_class.h"
#include "garment/package.h"

#include <optional>
#include <string>
#include <vector>

namespace toile::garment {

/// A girth of the body, and of the garment's pattern around the same place.
struct GirthFit {
    std::string_view name; ///< ISO 8559-1
    double body_m = 0.0;   ///< at rest, whatever the pose
    double garment_m = 0.0;
    double confidence = 0.0; ///< [0, 1] of the body's tape
    bool open = false;       ///< measured from front edge to front edge
    double moved_m = 0.0;    ///< how far along the body from its tape the garment's was laid
    /// The same of each size of the design, in its order; m.
    std::vector<double> sizes_m = {};

    [[nodiscard]] double ease_m() const { return garment_m - body_m; }
};

/// How far a garment reaches along the body.
struct LengthFit {
    std::string_view name; ///< arm_length: from the shoulder; crotch_height ...: from the floor
    double body_m = 0.0;
    double garment_m = 0.0; ///< to the sleeve's end, or the hem above the floor
    std::string text;       ///< "the sleeve ends 34 cm above the wrist"
};

/// Where the intended room is known from.
enum class EaseSource : std::uint8_t {
    invalid,
    garment,    ///< garment.json says it
    design,     ///< guessed: pattern against the body that it was made on
    size_chart, ///< guessed: pattern against the middle of the size chart
    wearer,     ///< guessed: the class nearest to what was measured here
};
[[nodiscard]] std::string_view name_of(EaseSource source);

struct RegionFit {
    FitRegion region = FitRegion::invalid;
    std::string_view girth; ///< of GirthFit that decides
    EaseClass ease_class = EaseClass::invalid;
    EaseSource source = EaseSource::invalid;
    double intended_m = 0.0;
    double ease_m = 0.0;
    Verdict verdict = Verdict::invalid;
    std::string text;
    double stretch_mean = 0.0; ///< of the larger of warp and weft at the region's vertices, >= 0
    double stretch_max = 0.0;  ///< largest of these
    double pressure_mean_pa = 0.0; ///< where the cloth touches; 0 when it does not
    double pressure_p95_pa = 0.0;
};

/// What went wrong, for machines.
enum class FitFailureCode : std::uint8_t {
    invalid,
    deep_contact,       ///< more than 0.1 % of the vertices deeper than 2 mm
    self_intersections, ///< more than 0.2 % of the triangles cut others
    overstretched,      ///< strain rms above 4 %
    fell_off,           ///< half of it is more than 25 cm from the body
    not_measured,       ///< no girth could be taken around the body
    no_size_advice,     ///< no size chart names a measurement that the body has
    plugin_failed,      ///< a plugin was switched off on the way
};
[[nodiscard]] std::string_view name_of(FitFailureCode code);

struct FitFailure {
    FitFailureCode code = FitFailureCode::invalid;
    std::string garment; ///< id, or "" when it concerns all
    std::string text;
};

struct ContactFit {
    std::size_t vertices = 0;
    std::size_t deep = 0; ///< more than 2 mm inside the body
    std::size_t triangles = 0;
    std::size_t cutting = 0; ///< cut by others of the same garment

    [[nodiscard]] double deep_fraction() const;
    [[nodiscard]] double self_intersections() const;
};

struct GarmentFit {
    std::string id, name, size;
    std::vector<GirthFit> girths;
    std::vector<LengthFit> lengths;
    std::vector<RegionFit> regions;
    std::vector<std::string> sizes;              ///< names, in the design's order
    std::optional<std::string> recommended_size; ///< of the size chart
    std::optional<std::string> between;          ///< and this one
    std::vector<std::string> reasons;
    ContactFit contact;
    StrainFigures strain;
    std::vector<float> gap_m, warp, weft, pressure_pa; ///< (nv) of the simulation mesh
};

struct FitReport {
    std::string body; ///< id
    std::vector<GarmentFit> garments;
    std::vector<FitFailure> failures;
};

/// A body as it stands. Views are borrowed.
struct WearerView {
    const body::BodyModel& model;
    std::span<const Vec3f> positions; ///< (nb) posed
    std::span<const Vec3f> normals;   ///< (nb)
    const body::JointTransforms& world;
};

/// A garment as it has come to hang. Views are borrowed.
struct WornView {
    const GarmentPackage& package;
    const GarmentSize& size;
    std::span<const Vec3f> bound;     ///< (nv) on the body in its rest pose
    std::span<const Vec3f> positions; ///< (nv)
    std::span<const Vec3f> normals;   ///< (nv) outward
    /// Of the body that the size was made on, or null.
    const std::map<std::string, double>* made_on = nullptr;
};

/// Measures bodies of one model once, then any garments that it wears.
class FitAssessor {
  public:
    /// Borrows the model. \throw Error naming the landmark that the model lacks
    explicit FitAssessor(const WearerView& wearer);

    /// Not for the per-frame path: some 0.1 s a garment. Failures go to `failures`.
    [[nodiscard]] GarmentFit assess(const WornView& worn, std::vector<FitFailure>& failures) const;

  private:
    WearerView wearer_;
    body::Measurer measurer_;
    body::Figure figure_; ///< as it stands
    std::vector<body::LaidMeasurement> tapes_;
    std::map<std::string_view, double> at_rest_; ///< m
};

/// Over all garments: fractions of all vertices and triangles, strain by rest area.
[[nodiscard]] ContactFit contact_of(const FitReport& report);
[[nodiscard]] StrainFigures strain_of(const FitReport& report);

} // namespace toile::garment
