// Fits dressed people seen by four simulated cameras in five poses, and compares the measurements
// with those of the body that wears the clothes.
//
//     dressed_fit_evaluation MODEL_FOLDER CASES_FOLDER [--period S] [--noise none|usual|full]
//         [--count N] [--json FILE]
//
// A case is a folder with `body.json` (who wears it) and `cache` (toile tryon --cache); its poses
// are reached every `--period` seconds.
#include "body/body_file.h"
#include "body/measurer.h"
#include "core/error.h"
#include "evaluation/simulated_views.h"
#include "geometry/nearest_surface.h"
#include "scape_fit/cloth_looseness.h"
#include "scape_fit/fitter.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
namespace sensor = toile::simulated_sensor;
namespace fit = toile::scape_fit;
namespace body = toile::body;
using toile::Vec3f;
using namespace toile::evaluation;

constexpr std::uint32_t kPoses = 5;
constexpr std::array kNames{"bust_girth",        "waist_girth", "hip_girth",
                            "thigh_girth",       "calf_girth",  "upper_arm_girth",
                            "neck_girth",        "arm_length",  "neck_to_hip_distance",
                            "inside_leg_length", "stature"};

/// Light, middle and dark; linear.
const std::array<Vec3f, 3> kSkins{Vec3f(0.78f, 0.48f, 0.35f), Vec3f(0.52f, 0.26f, 0.15f),
                                  Vec3f(0.16f, 0.065f, 0.033f)};

constexpr float kJersey = 0.001f; // metres thick
constexpr int kSuitRounds = 60;
const Vec3f kSuitColor(0.05f, 0.09f, 0.22f);

struct Settings {
    fs::path model, cases, json;
    double period = 1.1;
    std::string noise = "usual";
    std::string only;
    std::size_t count = 1000;
    bool compare = true, color = true, tight = false;
    fit::FitOptions fit = fit::options_for_pictures(4, kPoses);
};

sensor::Scenario scenario_of(const Settings& settings, std::uint64_t seed) {
    sensor::Scenario out = empty_room();
    out.seed = seed;
    out.color = settings.color;
    out.frames = kPoses;
    out.frames_per_second = 1.0 / settings.period;
    add_cameras(out, 4, settings.noise);
    return out;
}

sensor::PersonSettings person_of(sensor::BodyKind kind, const fs::path& source) {
    sensor::PersonSettings out;
    out.kind = kind;
    out.source = source;
    return out;
}

/// What was seen of a case.
struct Seen {
    std::vector<fit::Observation> observations;
    std::optional<toile::geometry::Plane> floor;
    void add(sensor::Simulator& simulator, std::size_t instant) {
        auto person = observe(simulator, instant);
        if (!person.trouble.empty()) throw toile::Error("nobody was seen: " + person.trouble);
        floor = person.floor;
        for (auto& one : person.observations)
            observations.push_back(std::move(one));
    }
};

using Mesh = toile::geometry::TriangleMesh;

/// What a suit of jersey covers: it lies on the skin from neck to wrists and ankles, and spans
/// hollows.
Mesh tight_suit(const Mesh& bare, std::span<const std::uint8_t> clothed) {
    std::vector<Vec3f> normals(bare.positions.size());
    toile::geometry::vertex_normals(bare.positions, bare.triangles, normals);
    Mesh out = bare;
    std::erase_if(out.triangles, [&](const toile::Triangle& t) {
        return clothed[t[0]] == 0 || clothed[t[1]] == 0 || clothed[t[2]] == 0;
    });
    for (int round = 0; round < kSuitRounds; ++round) {
        std::vector<Vec3f> sums(out.positions.size(), Vec3f::Zero());
        std::vector<float> counts(out.positions.size(), 0.0f);
        for (const auto& t : out.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                sums[t[k]] += out.positions[t[(k + 1) % 3]] + out.positions[t[(k + 2) % 3]];
                counts[t[k]] += 2.0f;
            }
        for (std::size_t v = 0; v < sums.size(); ++v) {
            if (counts[v] == 0.0f) continue;
            Vec3f& q = out.positions[v];
            q = sums[v] / counts[v];
            const float off = normals[v].dot(q - bare.positions[v]);
            q += std::max(0.0f, kJersey - off) * normals[v];
        }
    }
    return out;
}

/// Surfaces of an instant each, seen on their own.
Seen see_scenes(const Settings& settings, std::uint64_t seed,
                const std::vector<toile::assets::Scene>& scenes) {
    Seen out;
    const fs::path file =
        fs::temp_directory_path() / ("toile_seen_" + std::to_string(getpid()) + ".glb");
    for (std::size_t f = 0; f < scenes.size(); ++f) {
        toile::assets::save_scene(scenes[f], file);
        sensor::Scenario scenario = scenario_of(settings, seed + 100 * f);
        scenario.people.push_back(person_of(sensor::BodyKind::mesh, file));
        sensor::Simulator simulator(std::move(scenario), &rows_on_all_cores);
        simulator.show(0);
        out.add(simulator, f);
    }
    fs::remove(file);
    return out;
}

const body::Measurement* find(const body::Measurements& all, std::string_view name) {
    for (const body::Measurement& m : all)
        if (m.name == name) return &m;
    return nullptr;
}

struct Evaluation {
    explicit Evaluation(const Settings& wanted)
        : settings(wanted), model(settings.model), fitter(model), measurer(model.space().model()) {}

    nlohmann::ordered_json errors_of(const fit::FitResult& result,
                                     const body::Measurements& truth) {
        const auto rest = fit::rest_shape(model, result.state.shape);
        const auto found = measurer.measure(rest.positions, rest.skeleton);
        nlohmann::ordered_json out;
        for (const char* name : kNames)
            out[name] = 1000.0 * (find(found, name)->value_m - find(truth, name)->value_m);
        return out;
    }

    /// Mean distance of the true skin from what was found at an instant.
    double distance_mm(const toile::geometry::TriangleMesh& skin, const fit::FitResult& result,
                       std::size_t instant) const {
        fit::PosedLevel found;
        fit::pose_level(model, model.level(0), result.state.shape, result.state.poses[instant],
                        found);
        const toile::geometry::NearestSurface surface(found.positions, model.level(0).triangles);
        double sum = 0.0;
        for (const Vec3f& p : skin.positions)
            sum += static_cast<double>(surface.nearest(p).distance);
        return 1000.0 * sum / static_cast<double>(skin.positions.size());
    }

    nlohmann::ordered_json run(const fs::path& folder, std::uint64_t seed) {
        const auto file = body::load_body_file(folder / "body.json");
        const auto rest = body::shape_of(file, model.space());
        const auto truth = measurer.measure(rest.positions, rest.skeleton);
        sensor::Scenario scenario = scenario_of(settings, seed);
        scenario.people.push_back(person_of(sensor::BodyKind::surfaces, folder / "cache"));
        scenario.people.back().skin = kSkins[seed % kSkins.size()];
        sensor::Simulator simulator(std::move(scenario), &rows_on_all_cores);
        Seen seen;
        std::vector<toile::geometry::TriangleMesh> bare;
        nlohmann::ordered_json row;
        row["id"] = folder.filename().string();
        for (std::uint32_t f = 0; f < kPoses; ++f) {
            simulator.show(f);
            if (!settings.tight) seen.add(simulator, f);
            for (const auto& one : simulator.figures()[0]->surfaces())
                if (one.role == body::SurfaceRole::body) {
                    bare.emplace_back().positions = one.positions;
                    bare.back().triangles = one.surface.triangles;
                }
        }
        const Vec3f& skin = kSkins[seed % kSkins.size()];
        std::vector<toile::assets::Scene> undressed(bare.size()), suited(bare.size());
        const fit::FitLevel& full = model.level(0);
        for (std::size_t f = 0; f < bare.size(); ++f) {
            add_mesh(undressed[f], bare[f], skin);
            if (!settings.tight) continue;
            if (bare[f].positions.size() != full.clothed.size())
                throw toile::Error(folder.string() + ": its body is not of the model's topology");
            add_mesh(suited[f], bare[f], skin);
            add_mesh(suited[f], tight_suit(bare[f], full.clothed), kSuitColor);
        }
        if (settings.tight) seen = see_scenes(settings, seed, suited);
        fit::FitOptions options = settings.fit;
        options.floor = seen.floor;
        options.dressed = true;
        const double began = seconds();
        const auto beneath = fitter.fit(seen.observations, options, &rows_on_all_cores);
        row["seconds"] = seconds() - began;
        row["errors_mm"]["dressed"] = errors_of(beneath, truth);
        for (std::size_t f = 0; f < bare.size(); ++f)
            row["surface_mm"].push_back(distance_mm(bare[f], beneath, f));
        for (const auto& one : fit::measure_looseness(model, measurer, beneath.state,
                                                      seen.observations, &rows_on_all_cores))
            row["looseness"][one.girth] = {{"looseness", one.looseness},
                                           {"ease_mm", 1000.0 * one.ease_m}};
        if (settings.compare) {
            options.dressed = false;
            row["errors_mm"]["without_mitigation"] =
                errors_of(fitter.fit(seen.observations, options, &rows_on_all_cores), truth);
            const Seen naked = see_scenes(settings, seed, undressed);
            row["errors_mm"]["undressed"] =
                errors_of(fitter.fit(naked.observations, options, &rows_on_all_cores), truth);
        }
        return row;
    }

    const Settings& settings;
    fit::FitModel model;
    fit::Fitter fitter;
    body::Measurer measurer;
};

void run(const Settings& settings) {
    std::vector<fs::path> cases;
    for (const auto& entry : fs::directory_iterator(settings.cases))
        if (fs::exists(entry.path() / "body.json") &&
            entry.path().filename().string().find(settings.only) != std::string::npos)
            cases.push_back(entry.path());
    std::sort(cases.begin(), cases.end());
    Evaluation evaluation(settings);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < std::min(cases.size(), settings.count); ++i) {
        rows.push_back(evaluation.run(cases[i], 31 + i));
        std::printf("%s\n", rows.back().dump().c_str());
        std::fflush(stdout);
    }
    if (!settings.json.empty()) std::ofstream(settings.json) << rows.dump(1) << "\n";
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Fits dressed people seen by simulated cameras");
    app.add_option("model", settings.model, "Folder of the body space")->required();
    app.add_option("cases", settings.cases, "Folder of scripts/dressed-people")->required();
    app.add_option("--period", settings.period, "Seconds from pose to pose");
    app.add_option("--noise", settings.noise)->check(CLI::IsMember({"none", "usual", "full"}));
    app.add_option("--count", settings.count, "How many cases");
    app.add_option("--only", settings.only, "Cases whose names contain this");
    app.add_option("--json", settings.json, "Gets all figures");
    app.add_flag("!--dressed-only", settings.compare, "No fits to compare with");
    app.add_flag("--tight", settings.tight, "In a suit of jersey instead of the case's clothes");
    app.add_flag("!--no-color", settings.color, "Depth alone");
    app.add_option("--unknown", settings.fit.cloth.unknown_weight);
    app.add_option("--half", settings.fit.cloth.half_weight_m);
    app.add_option("--gap-noise", settings.fit.cloth.noise_m);
    app.add_option("--weight", settings.fit.dressed_shape_weight);
    CLI11_PARSE(app, argc, argv);
    try {
        run(settings);
    } catch (const std::exception& e) {
        return std::fprintf(stderr, "%s\n", e.what()), 1;
    }
    return 0;
}
