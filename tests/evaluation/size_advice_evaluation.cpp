// Which sizes people are advised after four cameras saw them, against what their true girths say.
//
//     size_advice_evaluation MODEL_FOLDER PEOPLE_FOLDER RESULTS.jsonl --garment PACKAGE...
//         [--noise usual|full|none] [--count N]
//
// One line a person is added to RESULTS; whoever stands there already is not fitted again, so that
// a run that was stopped goes on. The summary of all lines is printed as JSON.
#include "body/measurer.h"
#include "body/test_person.h"
#include "core/error.h"
#include "evaluation/simulated_views.h"
#include "garment/size_choice.h"
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
namespace garment = toile::garment;
using namespace toile::evaluation;
using Lengths = std::map<std::string, double>;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kFirstSeed = 11;
constexpr double kClear_m = 0.015; // so far from every boundary the size must be right

struct Settings {
    fs::path model, people, results;
    std::vector<fs::path> garments;
    std::string noise = "usual";
    std::size_t count = 100'000;
    double tolerance_m = garment::SizeChoiceOptions{}.tolerance_m;
};

/// Stands at rest, undressed, seen once from four sides.
sensor::Scenario scenario_of(const Settings& settings, const fs::path& person, std::uint64_t seed) {
    sensor::Scenario out = empty_room();
    out.seed = seed;
    out.frames = 1;
    sensor::PersonSettings who;
    who.kind = sensor::BodyKind::test_person;
    who.source = person;
    out.people.push_back(who);
    add_cameras(out, 4, settings.noise);
    return out;
}

/// The girths that charts name, of the fitted body by the rules of `toile measure`.
Lengths found_girths(const fit::FitModel& model, const body::Measurer& measurer,
                     fit::Fitter& fitter, const Settings& settings, const fs::path& person,
                     std::uint64_t seed) {
    sensor::Simulator simulator(scenario_of(settings, person, seed), &rows_on_all_cores);
    simulator.show(0);
    const auto seen = observe(simulator, 0);
    fit::FitOptions options = fit::options_for_pictures(4, 1);
    options.floor = seen.floor;
    const auto result = fitter.fit(seen.observations, options, &rows_on_all_cores);
    const auto rest = fit::rest_shape(model, result.state.shape);
    return body::as_map(measurer.measure(rest.positions, rest.skeleton));
}

std::vector<Json> read_lines(const fs::path& file) {
    std::vector<Json> out;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) out.push_back(Json::parse(line));
    return out;
}

void fit_people(const Settings& settings) {
    const std::vector<Json> before = read_lines(settings.results);
    std::vector<fs::path> people;
    for (const auto& entry : fs::directory_iterator(settings.people))
        if (fs::exists(entry.path() / "person.json")) people.push_back(entry.path());
    if (people.empty()) throw toile::Error(settings.people.string() + ": no test people in it");
    std::sort(people.begin(), people.end());
    people.resize(std::min(people.size(), settings.count));
    const fit::FitModel model(settings.model);
    const body::Measurer measurer(model.space().model());
    fit::Fitter fitter(model);
    std::ofstream out(settings.results, std::ios::app);
    for (std::size_t n = 0; n < people.size(); ++n) {
        const std::string id = people[n].filename().string();
        if (std::any_of(before.begin(), before.end(), [&](const Json& j) { return j["id"] == id; }))
            continue;
        const body::TestPerson person = body::load_test_person(people[n]);
        const Lengths found =
            found_girths(model, measurer, fitter, settings, people[n], kFirstSeed + n);
        Json row{{"id", id}, {"sex", person.woman ? "female" : "male"}, {"bmi", person.bmi}};
        for (const body::GirthPlane& plane : person.girths)
            if (const auto at = found.find(plane.name); at != found.end()) {
                row["true_m"][plane.name] = plane.girth;
                row["found_m"][plane.name] = at->second;
            }
        out << row.dump() << "\n" << std::flush;
        std::fprintf(stderr, "%s, %zu of %zu\n", id.c_str(), n + 1, people.size());
    }
}

/// The least distance of a charted girth from where one size ends and the next begins.
double to_boundary_m(const garment::GarmentPackage& package, const Lengths& body) {
    double least = 1e9;
    for (std::size_t i = 0; i + 1 < package.sizes.size(); ++i)
        for (const auto& [name, range] : package.sizes[i].entry.chart) {
            const auto& next = package.sizes[i + 1].entry.chart;
            if (!body.contains(name) || !next.contains(name)) continue;
            const double at = 0.5 * (range.maximum + next.at(name).minimum);
            least = std::min(least, std::abs(body.at(name) - at));
        }
    return least;
}

struct Count {
    std::size_t clear = 0, clear_right = 0, clear_between = 0; ///< `between` said where needless
    std::size_t near = 0, near_between = 0, near_either = 0;   ///< advised or named beside it
    std::size_t off_by_two = 0;
    double absolute_m = 0.0;
    std::size_t girths = 0;
    std::vector<std::string> wrong;
};

void count_person(const garment::GarmentPackage& package, const Json& row,
                  const garment::SizeChoiceOptions& options, Count& out) {
    const auto truth = row["true_m"].get<Lengths>();
    const auto found = row["found_m"].get<Lengths>();
    const garment::SizeChoice right = garment::choose_size(package, truth, options);
    const garment::SizeChoice advice = garment::choose_size(package, found, options);
    const std::size_t off =
        std::max(right.index, advice.index) - std::min(right.index, advice.index);
    const bool named = off == 0 || advice.between == right.index;
    const bool clear = to_boundary_m(package, truth) >= kClear_m;
    (clear ? out.clear : out.near) += 1;
    if (clear) out.clear_right += off == 0 ? 1 : 0;
    if (!clear) out.near_either += off <= 1 ? 1 : 0;
    (clear ? out.clear_between : out.near_between) += advice.between ? 1 : 0;
    out.off_by_two += off > 1 ? 1 : 0;
    for (const auto& [name, range] : package.sizes.front().entry.chart) {
        if (!truth.contains(name)) continue;
        out.absolute_m += std::abs(found.at(name) - truth.at(name));
        ++out.girths;
    }
    if ((clear && off > 0) || off > 1 || (!clear && !named))
        out.wrong.push_back(row["id"].get<std::string>() + ": " +
                            package.sizes[right.index].entry.name + " advised as " +
                            package.sizes[advice.index].entry.name);
}

Json summary(const Settings& settings) {
    const std::vector<Json> rows = read_lines(settings.results);
    Json out = Json::array();
    for (const fs::path& source : settings.garments) {
        const auto loaded = garment::load_package(source);
        const garment::GarmentPackage& package = *loaded;
        // What is made on women's bodies is advised to women.
        const bool women = package.sizes.front().entry.made_on.starts_with("women");
        Count count;
        for (const Json& row : rows)
            if ((row["sex"] == "female") == women)
                count_person(package, row, {settings.tolerance_m}, count);
        out.push_back(
            {{"garment", package.manifest.id},
             {"people", count.clear + count.near},
             {"clear", count.clear},
             {"clear_right", count.clear_right},
             {"clear_said_between", count.clear_between},
             {"near", count.near},
             {"near_said_between", count.near_between},
             {"near_within_one", count.near_either},
             {"off_by_two", count.off_by_two},
             {"mean_absolute_error_mm",
              1000.0 * count.absolute_m / std::max(1.0, static_cast<double>(count.girths))},
             {"wrong", count.wrong}});
    }
    return out;
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Advises sizes to test people and compares with their true girths");
    app.add_option("model", settings.model, "Folder of the body space")->required();
    app.add_option("people", settings.people, "Folder of toile avatar test-people")->required();
    app.add_option("results", settings.results, "Lines of earlier runs are kept")->required();
    app.add_option("--garment", settings.garments, "Packages whose charts are asked")->required();
    app.add_option("--noise", settings.noise)->check(CLI::IsMember({"none", "usual", "full"}));
    app.add_option("--count", settings.count, "How many people, of those in the folder");
    app.add_option("--tolerance", settings.tolerance_m, "Metres around a boundary: `between`");
    CLI11_PARSE(app, argc, argv);
    try {
        fit_people(settings);
        std::printf("%s\n", summary(settings).dump(1).c_str());
    } catch (const std::exception& e) {
        return std::fprintf(stderr, "%s\n", e.what()), 1;
    }
    return 0;
}
