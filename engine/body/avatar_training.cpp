#include "body/avatar_training.h"

#include "body/avatar_atlas.h"
#include "body/avatar_files.h"
#include "body/avatar_provenance.h"
#include "body/measurer.h"
#include "core/error.h"
#include "geometry/atlas.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace toile::body {
namespace {

constexpr const char* kAvatarVersion = "1.0.0";
constexpr int kTexels = 2048;
constexpr int kChartGap = 10;
constexpr int kFitRounds = 5;
constexpr double kLargestAmount = 1.5; // of a measure target; beyond, bodies look strange

/// A measurement and the pair of targets that changes it.
struct Slider {
    const char* measurement;
    const char* targets; ///< without -incr, -decr
};
constexpr std::array<Slider, 4> kSliders = {{{"bust_girth", "measure/measure-bust-circ"},
                                             {"waist_girth", "measure/measure-waist-circ"},
                                             {"hip_girth", "measure/measure-hips-circ"},
                                             {"thigh_girth", "measure/measure-thigh-circ"}}};

using Amounts = std::array<double, kSliders.size()>;

/// What all avatars share.
struct Workshop {
    const MakeHumanData& data;
    const AvatarTemplate& avatar;
    const ShapeCarrier& carrier;
    BodyModel common;  ///< topology, weights, parts and landmarks
    Measurer measurer; ///< of bodies like it
};

/// The template as a body model, in the shape it was made from.
BodyModel make_common(const AvatarTemplate& avatar, const MakeHumanData& data) {
    BodyModel out;
    out.id = "template";
    out.rest = avatar.mesh;
    out.skeleton = symmetric(avatar.skeleton);
    out.skin = make_skin_weights(avatar, data);
    out.parts = make_part_labels(out.skin);
    out.landmarks = find_landmarks(avatar);
    return out;
}

/// A body while it is fitted.
struct Draft {
    std::vector<Vec3f> positions;
    Skeleton skeleton;
    Measurements measurements;

    [[nodiscard]] double measured(std::string_view name) const {
        for (const Measurement& m : measurements)
            if (m.name == name) return m.value_m;
        throw Error("avatars are not fitted to " + std::string(name));
    }
};

Draft make_draft(const Workshop& shop, double woman, const Amounts& amounts, double scale) {
    ShapeRecipe recipe = adult_recipe(woman);
    for (std::size_t i = 0; i < kSliders.size(); ++i)
        if (amounts[i] != 0.0)
            recipe[std::string(kSliders[i].targets) + (amounts[i] > 0.0 ? "-incr" : "-decr")] =
                std::abs(amounts[i]);
    const BaseShape shape = make_base_shape(shop.data, recipe, scale);
    Draft out;
    out.positions = shop.carrier.carry(shape);
    out.skeleton = symmetric(shape.skeleton);
    out.measurements = shop.measurer.measure(out.positions, out.skeleton);
    return out;
}

/// Solves scale and targets for the wanted measurements: one secant per slider and round.
Draft fit(const Workshop& shop, const AvatarSpec& spec) {
    Amounts amounts{}, step{};
    step.fill(0.3);
    double scale = 1.0;
    Draft draft = make_draft(shop, spec.woman, amounts, scale);
    for (int round = 0; round < kFitRounds; ++round) {
        scale *= spec.wanted.at("stature") / draft.measured("stature");
        draft = make_draft(shop, spec.woman, amounts, scale);
        for (std::size_t i = 0; i < kSliders.size(); ++i) {
            const auto wanted = spec.wanted.find(kSliders[i].measurement);
            if (wanted == spec.wanted.end()) continue;
            const double missing = wanted->second - draft.measured(wanted->first);
            if (std::abs(missing) < 0.0005) continue;
            Amounts tried = amounts;
            tried[i] += std::copysign(step[i], missing);
            const double gain = make_draft(shop, spec.woman, tried, scale).measured(wanted->first) -
                                draft.measured(wanted->first);
            if (std::abs(gain) < 1e-5) continue;
            amounts[i] += (tried[i] - amounts[i]) * missing / gain;
            amounts[i] = std::clamp(amounts[i], -kLargestAmount, kLargestAmount);
            step[i] = std::max(0.05, 0.5 * step[i]);
        }
        draft = make_draft(shop, spec.woman, amounts, scale);
    }
    return draft;
}

/// Names of all targets that training reads.
std::vector<std::string> training_targets() {
    std::vector<std::string> out;
    for (const auto& [name, amount] : template_recipe())
        out.push_back(name);
    for (const Slider& slider : kSliders)
        for (const char* end : {"-incr", "-decr"})
            out.push_back(std::string(slider.targets) + end);
    return out;
}

std::optional<DataCheck> check_of(const TrainingOptions& options, const MakeHumanData& data) {
    if (options.check.empty()) return std::nullopt;
    options.progress(0.02, "checking the data against its other copy");
    return check_data(data, MakeHumanData(options.check), training_targets());
}

} // namespace

std::vector<AvatarSpec> stock_avatars() {
    std::vector<AvatarSpec> out(3);
    out[0] = {
        "woman",
        "Woman",
        1.0,
        {{"stature", 1.68}, {"bust_girth", 0.90}, {"waist_girth", 0.72}, {"hip_girth", 0.944}},
        0.0f,
        {196, 178, 164},
        {128, 116, 112}};
    out[1] = {
        "man",
        "Man",
        0.0,
        {{"stature", 1.78}, {"bust_girth", 0.99}, {"waist_girth", 0.83}, {"hip_girth", 0.944}},
        0.0f,
        {178, 162, 148},
        {104, 104, 110}};
    out[2] = {
        "mannequin",
        "Mannequin",
        0.5,
        {{"stature", 1.74}, {"bust_girth", 0.93}, {"waist_girth", 0.76}, {"hip_girth", 0.923}},
        8.0f,
        {208, 203, 196},
        {150, 148, 145}};
    return out;
}

std::vector<BodyModel> train_avatars(const TrainingOptions& options) {
    const MakeHumanData data(options.data);
    const auto check = check_of(options, data);
    options.progress(0.05, "building the template");
    const AvatarTemplate avatar = make_avatar_template(data);
    options.progress(0.6, "carrying weights and shapes");
    const std::vector<float> smoothness(avatar.half, 0.0f);
    const ShapeCarrier carrier(avatar, smoothness);
    BodyModel common = make_common(avatar, data);
    const Workshop shop{data, avatar, carrier, common, Measurer(common)};
    common.layout = geometry::make_atlas(avatar.mesh.positions, avatar.mesh.triangles,
                                         make_charts(avatar, common.skin), {kTexels, kChartGap});

    std::vector<BodyModel> out;
    for (const auto& spec : stock_avatars()) {
        if (!options.ids.empty() &&
            std::find(options.ids.begin(), options.ids.end(), spec.id) == options.ids.end())
            continue;
        options.progress(0.7, "fitting " + spec.id);
        const Draft draft = fit(shop, spec);
        BodyModel model = common;
        model.id = spec.id;
        model.version = kAvatarVersion;
        model.name = spec.name;
        model.folder = options.out / spec.id;
        model.rest.positions = draft.positions;
        geometry::vertex_normals(model.rest.positions, model.rest.triangles, model.rest.normals);
        model.skeleton = draft.skeleton;
        model.measurements = as_map(draft.measurements);
        save_body_model(model,
                        paint_base_layer(avatar, model.layout, {spec.skin, spec.layer}, kTexels),
                        provenance_text(spec.id, spec.name, data, check), model.folder);
        out.push_back(std::move(model));
    }
    if (out.empty()) throw Error("no avatar of that name; known: woman, man, mannequin");
    return out;
}

} // namespace toile::body
