// Fits test people seen by simulated cameras and compares with their true surfaces.
//
//     body_fit_evaluation MODEL_FOLDER PEOPLE_FOLDER [--views 4|1] [--noise none|usual|full]
//         [--pose FILE]... [--scan] [--components-only] [--count N] [--json FILE]
//
// Everything is compared in the first pose, as the cameras saw it.
#include "evaluation/fit_errors.h"
#include "evaluation/simulated_views.h"
#include "scape_fit/fitter.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
namespace sensor = toile::simulated_sensor;
namespace fit = toile::scape_fit;
namespace body = toile::body;
using toile::Vec3f;
using namespace toile::evaluation;

constexpr std::size_t kScanPoints = 40000;
constexpr std::uint64_t kFirstSeed = 11;

struct Settings {
    fs::path model, people;
    int views = 4;
    std::string noise = "usual";
    std::vector<fs::path> poses;
    std::size_t first = 0, count = 1000;
    fs::path json;
    std::optional<double> shape_weight, information, deviation, correlation; // the usual ones
    bool components_only = false;
    bool scan = false; // of the true surface, all around; no cameras
};

/// Four sides at 2.4 m, or the front alone; landscape pictures.
sensor::Scenario scenario_of(const Settings& settings, const fs::path& person, std::uint64_t seed) {
    sensor::Scenario out = empty_room();
    out.seed = seed;
    out.frames = static_cast<std::uint32_t>(std::max<std::size_t>(1, settings.poses.size()));
    out.frames_per_second = 1.0;
    sensor::PersonSettings who;
    who.kind = sensor::BodyKind::test_person;
    who.source = person;
    who.poses = settings.poses;
    who.hold_s = 1.0;
    who.change_s = 1e-3;
    out.people.push_back(who);
    add_cameras(out, settings.views, settings.noise);
    return out;
}

struct Errors {
    std::map<std::string, std::vector<double>> of; ///< name -> signed errors, mm
    void add(const std::string& name, double mm) { of[name].push_back(mm); }
};

void print(const Errors& errors) {
    std::printf("%-28s %5s %8s %8s %8s %8s\n", "", "n", "mean", "mean|.|", "sd", "worst");
    for (const auto& [name, values] : errors.of) {
        double sum = 0, absolute = 0, squares = 0, worst = 0;
        for (const double v : values) {
            sum += v, absolute += std::abs(v), squares += v * v;
            if (std::abs(v) > std::abs(worst)) worst = v;
        }
        const auto n = static_cast<double>(values.size());
        std::printf("%-28s %5zu %8.2f %8.2f %8.2f %8.2f\n", name.c_str(), values.size(), sum / n,
                    absolute / n, std::sqrt(std::max(0.0, squares / n - sum * sum / n / n)), worst);
    }
}

struct Seen {
    std::vector<fit::Observation> observations;
    std::optional<toile::geometry::Plane> floor;
    std::vector<Vec3f> truth;       // (nv) of the first instant
    body::JointTransforms joints;   // of the first instant
    std::vector<std::uint8_t> seen; // (nv) by some camera then; empty: a scan
};

fit::Observation scan_of(const body::TestPerson& person, std::span<const Vec3f> positions,
                         std::size_t instant) {
    toile::geometry::TriangleMesh mesh;
    mesh.positions.assign(positions.begin(), positions.end());
    mesh.triangles = person.rest.triangles;
    auto out = fit::sampled(mesh, kScanPoints);
    out.complete = true;
    out.instant = instant;
    return out;
}

Seen look_at(const Settings& settings, const body::TestPerson& person, const fs::path& folder,
             std::uint64_t seed) {
    sensor::Simulator simulator(scenario_of(settings, folder, seed), &rows_on_all_cores);
    Seen out;
    const std::size_t instants = std::max<std::size_t>(1, settings.poses.size());
    for (std::size_t f = 0; f < instants; ++f) {
        simulator.show(static_cast<std::uint32_t>(f));
        const auto& figure = *simulator.figures()[0];
        const auto& positions = figure.surfaces()[0].positions;
        if (f == 0) {
            out.truth = positions;
            out.joints = *figure.joints();
        }
        if (settings.scan) {
            out.observations.push_back(scan_of(person, positions, f));
            continue;
        }
        if (f == 0)
            out.seen = seen_vertices(simulator,
                                     {out.truth, person.rest.triangles, person.parts, out.joints});
        auto seen = observe(simulator, f);
        out.floor = seen.floor;
        for (auto& one : seen.observations)
            out.observations.push_back(std::move(one));
    }
    return out;
}

fit::FitOptions options_of(const Settings& settings, const Seen& seen) {
    const std::size_t instants = std::max<std::size_t>(1, settings.poses.size());
    fit::FitOptions out =
        settings.scan
            ? fit::options_for_scan()
            : fit::options_for_pictures(static_cast<std::size_t>(settings.views), instants);
    out.floor = seen.floor;
    out.use_free_form = !settings.components_only;
    out.shape_weight = settings.shape_weight.value_or(out.shape_weight);
    out.free_form.deviation_m = settings.deviation.value_or(out.free_form.deviation_m);
    out.free_form.correlation_m = settings.correlation.value_or(out.free_form.correlation_m);
    out.free_form.information = settings.information.value_or(out.free_form.information);
    return out;
}

using Notes = std::vector<std::pair<std::string, double>>; // name, signed error in mm

void note_surfaces(const body::TestPerson& person, const PosedSurface& truth,
                   std::span<const std::uint8_t> seen, const PosedSurface& result,
                   const fit::FitLevel& level, Notes& notes) {
    const Selection core = [&](std::size_t v) { return in_core(person, v); };
    notes.emplace_back("surface core", mean_distance(truth, core, result));
    notes.emplace_back("surface core aligned", aligned_distance(truth, core, result));
    notes.emplace_back("surface core back",
                       mean_distance(
                           result, [&](std::size_t v) { return level.trust[v] > 0.99f; }, truth));
    notes.emplace_back("surface ends", mean_distance(
                                           truth, [&](std::size_t v) { return !core(v); }, result));
    if (seen.empty()) return;
    for (const bool wanted : {true, false})
        notes.emplace_back(
            wanted ? "surface seen" : "surface unseen",
            mean_distance(
                truth, [&](std::size_t v) { return core(v) && (seen[v] != 0) == wanted; }, result));
}

/// Of the core's area, what no camera sees.
double unseen_share(const body::TestPerson& person, const Seen& seen) {
    const auto areas = vertex_areas(seen.truth, person.rest.triangles);
    double unseen = 0.0, all = 0.0;
    for (std::size_t v = 0; v < areas.size(); ++v) {
        if (!in_core(person, v)) continue;
        all += static_cast<double>(areas[v]);
        if (seen.seen[v] == 0) unseen += static_cast<double>(areas[v]);
    }
    return unseen / all;
}

Notes compare(const body::TestPerson& person, const Seen& seen, const fit::FitModel& model,
              const fit::FitResult& found) {
    const fit::FitLevel& full = model.level(0);
    fit::PosedLevel posed;
    fit::pose_level(model, full, found.state.shape, found.state.poses[0], posed);
    const PosedSurface truth{seen.truth, person.rest.triangles, person.parts, seen.joints};
    const PosedSurface result{posed.positions, full.triangles, model.space().model().parts,
                              posed.world};
    Notes notes;
    note_surfaces(person, truth, seen.seen, result, full, notes);
    for (const auto& [name, error] : girth_errors(person, truth, result))
        notes.emplace_back("girth " + name, error);
    for (const auto& [name, error] : length_errors(person, truth, result))
        notes.emplace_back("length " + name, error);
    float top = 0.0f;
    for (const Vec3f& p : fit::rest_shape(model, found.state.shape).positions)
        top = std::max(top, p.y());
    notes.emplace_back("length stature_at_rest",
                       1000.0 * (static_cast<double>(top) - person.lengths.at("stature")));
    for (const auto j : {body::Joint::left_upper_arm, body::Joint::left_lower_arm,
                         body::Joint::left_hand, body::Joint::left_upper_leg,
                         body::Joint::left_lower_leg, body::Joint::neck, body::Joint::hips}) {
        const auto k = static_cast<std::size_t>(j);
        notes.emplace_back(
            "joint " + std::string(body::joint_name(j)),
            1000.0 * static_cast<double>(
                         (posed.world[k].translation - seen.joints[k].translation).norm()));
    }
    return notes;
}

nlohmann::ordered_json row_of(const body::TestPerson& person, const fit::FitResult& found,
                              double took_s, const Notes& notes) {
    nlohmann::ordered_json row;
    row["id"] = person.id;
    row["sex"] = person.woman ? "female" : "male";
    row["sex_found"] = body::sex_name(found.sex);
    row["bmi"] = person.bmi;
    row["stature_m"] = person.lengths.at("stature");
    row["volume_m3"] = person.volume_m3;
    row["seconds"] = took_s;
    for (const body::GirthPlane& plane : person.girths)
        row["true_girths_m"][plane.name] = plane.girth;
    for (const auto& [name, error] : notes)
        row["errors_mm"][name] = error;
    return row;
}

void run(const Settings& settings) {
    const fit::FitModel model(settings.model);
    fit::Fitter fitter(model);
    std::vector<fs::path> people;
    for (const auto& entry : fs::directory_iterator(settings.people))
        if (fs::exists(entry.path() / "person.json")) people.push_back(entry.path());
    std::sort(people.begin(), people.end());
    Errors errors;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (std::size_t n = settings.first; n < people.size() && rows.size() < settings.count; ++n) {
        const body::TestPerson person = body::load_test_person(people[n]);
        const Seen seen = look_at(settings, person, people[n], kFirstSeed + n);
        const double began = seconds();
        const fit::FitResult found =
            fitter.fit(seen.observations, options_of(settings, seen), &rows_on_all_cores);
        const double took = seconds() - began;
        const Notes notes = compare(person, seen, model, found);
        for (const auto& [name, error] : notes)
            errors.add(name, error);
        rows.push_back(row_of(person, found, took, notes));
        if (!seen.seen.empty()) rows.back()["unseen_share"] = unseen_share(person, seen);
        std::printf("%s%s bmi %.1f: %.2f s, rms %.1f mm, paired %.2f, |c| %.2f, sex %s%s, core "
                    "%.2f mm\n",
                    person.id.c_str(), person.woman ? " w" : " m", person.bmi, took,
                    1000.0 * found.rms_m, found.paired_share, found.state.shape.coefficients.norm(),
                    found.sex == body::Sex::female ? "w" : "m",
                    (found.sex == body::Sex::female) == person.woman ? "" : " (wrong)",
                    notes.front().second);
        std::fflush(stdout);
    }
    print(errors);
    if (!settings.json.empty()) std::ofstream(settings.json) << rows.dump(1) << "\n";
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Fits test people seen by simulated cameras");
    app.add_option("model", settings.model, "Folder of the body space")->required();
    app.add_option("people", settings.people, "Folder of toile avatar test-people")->required();
    app.add_option("--views", settings.views, "4 sides, or 1: the front alone")
        ->check(CLI::IsMember({1, 4}));
    app.add_option("--noise", settings.noise)->check(CLI::IsMember({"none", "usual", "full"}));
    app.add_option("--pose", settings.poses, "Instants with these poses, not one at rest");
    app.add_option("--first", settings.first, "People before this one are left out");
    app.add_option("--count", settings.count, "How many people");
    app.add_option("--json", settings.json, "Gets all figures");
    app.add_flag("--scan", settings.scan, "Fits to the whole true surface, not to pictures");
    app.add_flag("--components-only", settings.components_only, "Without free-form detail");
    app.add_option("--weight", settings.shape_weight, "Of the shape prior (P5 eq. 23)");
    app.add_option("--information", settings.information, "Of the free form");
    app.add_option("--deviation", settings.deviation, "Of the free form, metres");
    app.add_option("--correlation", settings.correlation, "Of the free form, metres");
    CLI11_PARSE(app, argc, argv);
    try {
        run(settings);
    } catch (const std::exception& e) {
        return std::fprintf(stderr, "%s\n", e.what()), 1;
    }
    return 0;
}
