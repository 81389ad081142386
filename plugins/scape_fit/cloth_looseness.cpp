#include "scape_fit/cloth_looseness.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::scape_fit {
namespace {

constexpr std::array<const char*, 6> kGirths{"bust_girth",      "waist_girth", "hip_girth",
                                             "upper_arm_girth", "thigh_girth", "calf_girth"};
// Cloth stands off farther and folds more than skin differs from the model.
constexpr FreeFormOptions kClothField{0.04, 0.12, 1e8};
constexpr float kClothReach = 0.15f; // metres

std::array<double, kGirths.size()> girths_of(const FitModel& model, const body::Measurer& measurer,
                                             const FitShape& shape) {
    const auto rest = rest_shape(model, shape);
    const auto measured = measurer.measure(rest.positions, rest.skeleton);
    std::array<double, kGirths.size()> out{};
    for (std::size_t i = 0; i < kGirths.size(); ++i)
        for (const body::Measurement& m : measured)
            if (m.name == kGirths[i]) out[i] = m.value_m;
    return out;
}

/// The shape whose surface is the cloth of one instant.
FitShape cloth_shape(const FitModel& model, FreeForm& field, const FitState& state,
                     std::size_t instant, std::span<const Observation> observations,
                     const RowLoop& rows) {
    const FitLevel& full = model.level(0);
    PosedLevel posed;
    pose_level(model, full, state.shape, state.poses[instant], posed);
    Associator associator(full);
    associator.set_surface(posed);
    AssociationOptions pairing;
    pairing.reach_m = kClothReach;
    pairing.scale_m = kClothReach;
    pairing.empty_weight = 0.0f;
    std::vector<Association> associations;
    for (const Observation& one : observations) {
        if (one.instant != instant) continue;
        ObservedPoints points(one);
        if (one.camera < state.cameras.size()) points.correct(state.cameras[one.camera]);
        associator.associate(points, pairing, rows, associations.emplace_back());
    }
    std::vector<const PosedLevel*> surfaces(associations.size(), &posed);
    std::vector<const Association*> pairs;
    pairs.reserve(associations.size());
    for (const Association& one : associations)
        pairs.push_back(&one);
    FitShape out = state.shape;
    field.solve(surfaces, pairs, kClothField, out.offsets);
    return out;
}

} // namespace

std::vector<Looseness> measure_looseness(const FitModel& model, const body::Measurer& measurer,
                                         const FitState& state,
                                         std::span<const Observation> observations,
                                         const RowLoop& rows) {
    const std::size_t instants = state.poses.size();
    if (instants < 2) return {};
    const auto body = girths_of(model, measurer, state.shape);
    FreeForm field(model.level(0));
    std::vector<std::array<double, kGirths.size()>> cloth;
    for (std::size_t f = 0; f < instants; ++f)
        cloth.push_back(
            girths_of(model, measurer, cloth_shape(model, field, state, f, observations, rows)));
    std::vector<Looseness> out;
    for (std::size_t i = 0; i < kGirths.size(); ++i) {
        double mean = 0.0, variance = 0.0;
        for (const auto& one : cloth)
            mean += one[i] / static_cast<double>(instants);
        for (const auto& one : cloth)
            variance += std::pow((one[i] - mean) / mean, 2) / static_cast<double>(instants);
        out.push_back({kGirths[i], std::sqrt(variance), mean - body[i]});
    }
    return out;
}

} // namespace toile::scape_fit
