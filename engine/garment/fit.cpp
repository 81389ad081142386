#include "garment/fit.h"

#include "garment/fit_parts.h"
#include "garment/pattern_tape.h"
#include "garment/size_choice.h"
#include "geometry/self_intersection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::garment {
namespace {

constexpr std::array<std::string_view, 5> kSourceNames = {"invalid", "garment", "design",
                                                          "size_chart", "wearer"};
constexpr std::array<std::string_view, 8> kFailureNames = {
    "invalid",  "deep_contact", "self_intersections", "overstretched",
    "fell_off", "not_measured", "no_size_advice",     "plugin_failed"};

// Girths that a plane takes; a region's come first.
const std::vector<std::string> kGirths = {
    "bust_girth",  "waist_girth", "hip_girth",   "upper_arm_girth",  "forearm_girth",
    "thigh_girth", "knee_girth",  "calf_girth",  "under_bust_girth", "high_hip_girth",
    "neck_girth",  "elbow_girth", "wrist_girth", "mid_thigh_girth",  "ankle_girth"};

/// As cutters measure: a chest below the armholes, a short sleeve where there is one. Fronts are
/// open around the trunk only.
TapeOptions tape_options(std::string_view girth) {
    const bool trunk = girth == "bust_girth" || girth == "under_bust_girth" ||
                       girth == "waist_girth" || girth == "high_hip_girth" || girth == "hip_girth";
    return {girth == "bust_girth" || girth == "upper_arm_girth" ? 0.10f : 0.02f, trunk};
}

double share(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

ContactFit contact_with(const WearerView& wearer, const WornView& worn) {
    const std::vector<Triangle>& triangles = worn.size.simulation.triangles;
    const ClothSurface bound{worn.bound, triangles}, now{worn.positions, triangles};
    ContactMetrics metrics(wearer.model.rest.positions, wearer.model.rest.triangles,
                           std::span(&bound, 1));
    const ContactFigures figures = metrics.measure(wearer.positions, std::span(&now, 1));
    const auto cutting = geometry::self_intersecting(worn.positions, triangles);
    return {figures.vertices, figures.deep_vertices, triangles.size(),
            static_cast<std::size_t>(std::count(cutting.begin(), cutting.end(), 1))};
}

void advise(const WornView& worn, const std::map<std::string, double>& measurements,
            GarmentFit& fit, std::vector<FitFailure>& failures) {
    for (const GarmentSize& size : worn.package.sizes)
        fit.sizes.push_back(size.entry.name);
    try {
        const SizeChoice choice = choose_size(worn.package, measurements);
        fit.recommended_size = fit.sizes[choice.index];
        if (choice.between) fit.between = fit.sizes[*choice.between];
        fit.reasons = choice.reasons;
    } catch (const Error& e) {
        failures.push_back({FitFailureCode::no_size_advice, fit.id, e.what()});
    }
}

} // namespace

std::string_view name_of(EaseSource source) {
    return kSourceNames.at(static_cast<std::size_t>(source));
}

std::string_view name_of(FitFailureCode code) {
    return kFailureNames.at(static_cast<std::size_t>(code));
}

double ContactFit::deep_fraction() const {
    return share(deep, vertices);
}

double ContactFit::self_intersections() const {
    return share(cutting, triangles);
}

FitAssessor::FitAssessor(const WearerView& wearer)
    : wearer_(wearer), measurer_(wearer.model),
      figure_(measurer_.figure(wearer.positions, wearer.world)) {
    const auto definitions = body::measurement_definitions(kGirths);
    tapes_ = body::lay_tapes(figure_, definitions);
    const auto rest = measurer_.measure(wearer.model.rest.positions, wearer.model.skeleton);
    for (const body::Measurement& m : rest)
        at_rest_[m.name] = m.value_m;
}

GarmentFit FitAssessor::assess(const WornView& worn, std::vector<FitFailure>& failures) const {
    GarmentFit fit;
    fit.id = worn.package.manifest.id;
    fit.name = worn.package.manifest.name;
    fit.size = worn.size.entry.name;
    const std::vector<Triangle>& triangles = worn.size.simulation.triangles;

    // Girths on the pattern, and the verdicts that rest on them.
    for (const body::LaidMeasurement& laid : tapes_) {
        const auto tape =
            lay_around(laid.reading, {wearer_.positions, wearer_.model.rest.triangles},
                       {worn.positions, triangles}, worn.size.material_coords,
                       tape_options(laid.definition->name));
        if (!tape) continue;
        GirthFit girth;
        girth.name = laid.definition->name;
        girth.body_m = at_rest_.at(girth.name);
        girth.garment_m = tape->flat_length(worn.size.material_coords);
        girth.confidence = laid.reading.confidence;
        girth.open = tape->open;
        girth.moved_m = tape->moved_m;
        for (const GarmentSize& size : worn.package.sizes)
            girth.sizes_m.push_back(tape->flat_length(size.material_coords));
        fit.girths.push_back(std::move(girth));
    }
    fit.regions = judge_regions(worn, fit.girths);

    // Vertex by vertex.
    SkinGap gap(wearer_.model.rest.triangles, wearer_.positions.size(), worn.positions.size());
    gap.find({wearer_.positions, wearer_.normals}, worn.positions);
    ClothStrain strain(triangles, worn.size.material_coords, worn.positions.size());
    strain.measure(worn.positions);
    const Fabric& fabric = worn.package.manifest.fabric;
    strain.measure_pressure(worn.positions, worn.normals,
                            {fabric.stretch_warp_n_m, fabric.stretch_weft_n_m});
    const auto copied = [](std::span<const float> values) {
        return std::vector<float>(values.begin(), values.end());
    };
    fit.gap_m = copied(gap.gaps());
    fit.warp = copied(strain.warp());
    fit.weft = copied(strain.weft());
    fit.pressure_pa = copied(strain.pressure());
    constexpr float kTouching = 0.010f; // m
    for (std::size_t v = 0; v < fit.gap_m.size(); ++v)
        if (fit.gap_m[v] > kTouching) fit.pressure_pa[v] = 0.0f;
    fit.strain = strain.figures();
    add_strain(regions_of_vertices(wearer_, figure_, tapes_, gap, worn.positions), fit,
               fit.regions);

    fit.lengths = lengths_of(wearer_, figure_, gap, worn.positions);
    fit.contact = contact_with(wearer_, worn);
    std::map<std::string, double> measurements;
    for (const auto& [name, value] : at_rest_)
        measurements[std::string(name)] = value;
    for (const auto& [name, value] : wearer_.model.measurements)
        measurements[name] = value; // as --size auto sees them
    advise(worn, measurements, fit, failures);
    for (std::string& reason : other_sizes(fit))
        fit.reasons.push_back(std::move(reason));
    add_failures(fit, failures);
    return fit;
}

ContactFit contact_of(const FitReport& report) {
    ContactFit out;
    for (const GarmentFit& fit : report.garments) {
        out.vertices += fit.contact.vertices;
        out.deep += fit.contact.deep;
        out.triangles += fit.contact.triangles;
        out.cutting += fit.contact.cutting;
    }
    return out;
}

StrainFigures strain_of(const FitReport& report) {
    StrainFigures out;
    double squares = 0.0;
    for (const GarmentFit& fit : report.garments) {
        squares += fit.strain.rest_area * fit.strain.rms * fit.strain.rms;
        out.rest_area += fit.strain.rest_area;
        out.max = std::max(out.max, fit.strain.max);
    }
    if (out.rest_area > 0.0) out.rms = std::sqrt(squares / out.rest_area);
    return out;
}

} // namespace toile::garment
