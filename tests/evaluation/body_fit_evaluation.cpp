// Fits test people seen by simulated cameras and compares with their true surfaces.
//
//     body_fit_evaluation MODEL_FOLDER PEOPLE_FOLDER [--views 4|1] [--noise none|usual|full]
//         [--pose FILE]... [--count N] [--json FILE]
#include "body/measurer.h"
#include "body/test_person.h"
#include "evaluation/simulated_views.h"
#include "geometry/nearest_surface.h"
#include "scape_fit/fitter.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
namespace sensor = toile::simulated_sensor;
namespace fit = toile::scape_fit;
namespace body = toile::body;
using toile::Vec3f;
using namespace toile::evaluation;

constexpr int kAlignRounds = 6;

struct Settings {
    fs::path model, people;
    int views = 4;
    std::string noise = "usual";
    std::vector<fs::path> poses;
    int first = 0, count = 1000;
    fs::path json;
    std::optional<double> shape_weight, information, deviation, correlation; // the usual ones
    bool free_form = true;
    bool scan = false;
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

/// Area-weighted mean distance from the truth's vertices that `keep` to another surface, mm.
double mean_distance(std::span<const Vec3f> from, std::span<const float> areas,
                     const std::function<bool(std::size_t)>& keep, std::span<const Vec3f> to,
                     std::span<const toile::Triangle> triangles) {
    const toile::geometry::NearestSurface surface(to, triangles);
    double sum = 0.0, area = 0.0;
    for (std::size_t v = 0; v < from.size(); ++v) {
        if (!keep(v)) continue;
        sum += areas[v] * static_cast<double>(surface.nearest(from[v]).distance);
        area += areas[v];
    }
    return 1000.0 * sum / std::max(area, 1e-12);
}

std::vector<float> vertex_areas(std::span<const Vec3f> positions,
                                std::span<const toile::Triangle> triangles) {
    std::vector<float> out(positions.size(), 0.0f);
    for (const auto& t : triangles) {
        const float third =
            (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm() /
            6.0f;
        for (const auto v : t)
            out[v] += third;
    }
    return out;
}

/// The same as mean_distance once `from` was moved onto the other surface as a whole: what cameras
/// that all stand a little off do to a body is not its shape.
double aligned_distance(std::span<const Vec3f> from, std::span<const float> areas,
                        const std::function<bool(std::size_t)>& keep, std::span<const Vec3f> to,
                        std::span<const toile::Triangle> triangles) {
    const toile::geometry::NearestSurface surface(to, triangles);
    std::vector<Vec3f> moved(from.begin(), from.end());
    for (int round = 0; round < kAlignRounds; ++round) {
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
        for (std::size_t v = 0; v < moved.size(); ++v) {
            if (!keep(v)) continue;
            const auto near = surface.nearest(moved[v]);
            const toile::Triangle& t = triangles[near.triangle];
            const Vec3f across = (to[t[1]] - to[t[0]]).cross(to[t[2]] - to[t[0]]).normalized();
            Eigen::Matrix<double, 6, 1> row;
            row << moved[v].cross(across).cast<double>(), across.cast<double>();
            normal += areas[v] * row * row.transpose();
            right += areas[v] * row * static_cast<double>(across.dot(near.point - moved[v]));
        }
        const Eigen::Matrix<double, 6, 1> step = normal.ldlt().solve(right);
        const toile::Vec3d turn = step.head<3>();
        const Eigen::AngleAxisf by(static_cast<float>(turn.norm()),
                                   turn.normalized().cast<float>());
        for (Vec3f& p : moved)
            p = by * p + step.tail<3>().cast<float>();
    }
    return mean_distance(moved, areas, keep, to, triangles);
}

/// Head, hands and feet are told apart from the rest.
bool in_core(body::Part part, const body::TestPerson& person, std::size_t v) {
    if (part == body::Part::head) return false;
    const Vec3f& p = person.rest.positions[v];
    const auto near = [&](body::Joint a, body::Joint b) {
        return (p - person.skeleton.rest(a)).norm() < (p - person.skeleton.rest(b)).norm() &&
               (p - person.skeleton.rest(a)).norm() < 0.25f;
    };
    for (const bool left : {true, false}) {
        if (near(left ? body::Joint::left_hand : body::Joint::right_hand,
                 left ? body::Joint::left_lower_arm : body::Joint::right_lower_arm) &&
            (p - person.skeleton.rest(left ? body::Joint::left_lower_arm
                                           : body::Joint::right_lower_arm))
                    .norm() > 0.9f * (person.skeleton.rest(left ? body::Joint::left_hand
                                                                : body::Joint::right_hand) -
                                      person.skeleton.rest(left ? body::Joint::left_lower_arm
                                                                : body::Joint::right_lower_arm))
                                         .norm())
            return false;
        if (p.y() < person.skeleton.rest(body::Joint::left_foot).y()) return false;
    }
    return true;
}

/// A tape around the trunk goes around both thighs where they part above its plane, and not around
/// the arms, even where they grow together with the trunk in it.
std::vector<toile::Triangle> without_arms(std::span<const toile::Triangle> triangles,
                                          std::span<const body::Part> parts) {
    const auto arm = [&](std::uint32_t v) {
        return parts[v] == body::Part::left_upper_arm || parts[v] == body::Part::right_upper_arm ||
               parts[v] == body::Part::left_lower_arm || parts[v] == body::Part::right_lower_arm;
    };
    std::vector<toile::Triangle> out;
    for (const auto& t : triangles)
        if (!arm(t[0]) && !arm(t[1]) && !arm(t[2])) out.push_back(t);
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

void run(const Settings& settings) {
    const fit::FitModel model(settings.model);
    fit::Fitter fitter(model);
    const body::Measurer measurer(model.space().model());
    std::vector<fs::path> people;
    for (const auto& entry : fs::directory_iterator(settings.people))
        if (fs::exists(entry.path() / "person.json")) people.push_back(entry.path());
    std::sort(people.begin(), people.end());
    Errors errors;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    int done = 0;
    for (std::size_t n = static_cast<std::size_t>(settings.first);
         n < people.size() && done < settings.count; ++n, ++done) {
        const body::TestPerson person = body::load_test_person(people[n]);
        sensor::Simulator simulator(scenario_of(settings, people[n], 11 + n), &rows_on_all_cores);
        std::vector<fit::Observation> observations;
        const auto instants = std::max<std::size_t>(1, settings.poses.size());
        fit::FitOptions options =
            settings.scan
                ? fit::options_for_scan()
                : fit::options_for_pictures(static_cast<std::size_t>(settings.views), instants);
        std::vector<std::vector<Vec3f>> truths;
        std::vector<body::JointTransforms> joints;
        for (std::size_t f = 0; f < instants; ++f) {
            simulator.show(static_cast<std::uint32_t>(f));
            const auto& figure = *simulator.figures()[0];
            truths.push_back(figure.surfaces()[0].positions);
            joints.push_back(*figure.joints());
            if (settings.scan) {
                toile::geometry::TriangleMesh mesh;
                mesh.positions = truths.back();
                mesh.triangles = person.rest.triangles;
                auto all = fit::sampled(mesh, 40000);
                all.complete = true;
                all.instant = f;
                observations.push_back(std::move(all));
                continue;
            }
            auto seen = observe(simulator, f);
            options.floor = seen.floor;
            for (auto& one : seen.observations)
                observations.push_back(std::move(one));
        }
        options.use_free_form = settings.free_form;
        options.shape_weight = settings.shape_weight.value_or(options.shape_weight);
        options.free_form.deviation_m = settings.deviation.value_or(options.free_form.deviation_m);
        options.free_form.correlation_m =
            settings.correlation.value_or(options.free_form.correlation_m);
        options.free_form.information =
            settings.information.value_or(options.free_form.information);
        const double began = seconds();
        const fit::FitResult result = fitter.fit(observations, options, &rows_on_all_cores);
        const double took = seconds() - began;
        const fit::FitLevel& full = model.level(0);
        fit::PosedLevel posed;
        fit::pose_level(model, full, result.state.shape, result.state.poses[0], posed);
        const auto& truth = truths[0];
        const auto areas = vertex_areas(truth, person.rest.triangles);
        const double core = mean_distance(
            truth, areas, [&](std::size_t v) { return in_core(person.parts[v], person, v); },
            posed.positions, full.triangles);
        nlohmann::ordered_json row;
        row["id"] = person.id;
        row["sex"] = person.woman ? "female" : "male";
        row["sex_found"] = body::sex_name(result.sex);
        row["bmi"] = person.bmi;
        row["stature_m"] = person.lengths.at("stature");
        row["volume_m3"] = person.volume_m3;
        row["seconds"] = took;
        for (const body::GirthPlane& plane : person.girths)
            row["true_girths_m"][plane.name] = plane.girth;
        const auto note = [&](const std::string& name, double mm) {
            errors.add(name, mm);
            row["errors_mm"][name] = mm;
        };
        note("surface core", core);
        note("surface core aligned",
             aligned_distance(
                 truth, areas, [&](std::size_t v) { return in_core(person.parts[v], person, v); },
                 posed.positions, full.triangles));
        note("surface core back",
             mean_distance(
                 posed.positions, vertex_areas(posed.positions, full.triangles),
                 [&](std::size_t v) { return full.trust[v] > 0.99f; }, truth,
                 person.rest.triangles));
        note("surface ends",
             mean_distance(
                 truth, areas, [&](std::size_t v) { return !in_core(person.parts[v], person, v); },
                 posed.positions, full.triangles));
        for (const body::GirthPlane& plane : person.girths) {
            const auto j = static_cast<std::size_t>(plane.joint);
            toile::RigidTransform moved;
            moved.rotation = joints[0][j].rotation;
            moved.translation =
                joints[0][j].translation - moved.rotation * person.skeleton.rest_positions[j];
            const bool trunk = plane.name == "bust_girth" || plane.name == "waist_girth" ||
                               plane.name == "hip_girth";
            const auto girth_of = [&](std::span<const Vec3f> positions,
                                      std::span<const toile::Triangle> triangles,
                                      std::span<const body::Part> parts) {
                if (!trunk) return body::girth_in(plane, moved, positions, triangles);
                const auto kept = without_arms(triangles, parts);
                std::vector<Vec3f> points;
                const auto cut = toile::geometry::Plane::through(moved * plane.point,
                                                                 moved.rotation * plane.normal);
                for (const auto& loop : toile::geometry::slice(positions, kept, cut))
                    points.insert(points.end(), loop.points.begin(), loop.points.end());
                return std::optional<double>(toile::geometry::hull_girth(points, cut));
            };
            const auto true_girth = girth_of(truth, person.rest.triangles, person.parts);
            const auto girth =
                girth_of(posed.positions, full.triangles, model.space().model().parts);
            if (true_girth && girth)
                note("girth " + plane.name, 1000.0 * (*girth - *true_girth));
            else
                std::printf("  no girth %s\n", plane.name.c_str());
        }
        const auto rest = fit::rest_shape(model, result.state.shape);
        float top = 0.0f;
        for (const Vec3f& p : rest.positions)
            top = std::max(top, p.y());
        note("length stature", 1000.0 * (static_cast<double>(top) - person.lengths.at("stature")));
        for (const auto j : {body::Joint::left_upper_arm, body::Joint::left_lower_arm,
                             body::Joint::left_hand, body::Joint::left_upper_leg,
                             body::Joint::left_lower_leg, body::Joint::neck, body::Joint::hips})
            note("joint " + std::string(body::joint_name(j)),
                 1000.0 *
                     static_cast<double>((posed.world[static_cast<std::size_t>(j)].translation -
                                          joints[0][static_cast<std::size_t>(j)].translation)
                                             .norm()));
        rows.push_back(row);
        std::printf("%s%s bmi %.1f: %.2f s, rms %.1f mm, paired %.2f, |c| %.2f, sex %s%s, core "
                    "%.2f mm\n",
                    person.id.c_str(), person.woman ? " w" : " m", person.bmi, took,
                    1000.0 * result.rms_m, result.paired_share,
                    result.state.shape.coefficients.norm(),
                    result.sex == body::Sex::female ? "w" : "m",
                    (result.sex == body::Sex::female) == person.woman ? "" : " (wrong)", core);
        std::fflush(stdout);
    }
    print(errors);
    if (!settings.json.empty()) std::ofstream(settings.json) << rows.dump(1) << "\n";
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    if (argc < 3) return std::fputs("usage: see the head of the source\n", stderr), 2;
    settings.model = argv[1];
    settings.people = argv[2];
    for (int i = 3; i < argc; ++i) {
        const std::string key = argv[i];
        const auto value = [&] { return std::string(i + 1 < argc ? argv[++i] : ""); };
        if (key == "--views")
            settings.views = std::stoi(value());
        else if (key == "--noise")
            settings.noise = value();
        else if (key == "--pose")
            settings.poses.emplace_back(value());
        else if (key == "--count")
            settings.count = std::stoi(value());
        else if (key == "--json")
            settings.json = value();
        else if (key == "--first")
            settings.first = std::stoi(value());
        else if (key == "--weight")
            settings.shape_weight = std::stod(value());
        else if (key == "--information")
            settings.information = std::stod(value());
        else if (key == "--deviation")
            settings.deviation = std::stod(value());
        else if (key == "--correlation")
            settings.correlation = std::stod(value());
        else if (key == "--components-only")
            settings.free_form = false;
        else if (key == "--scan")
            settings.scan = true;
        else
            return std::fprintf(stderr, "unknown option %s\n", key.c_str()), 2;
    }
    try {
        run(settings);
    } catch (const std::exception& e) {
        return std::fprintf(stderr, "%s\n", e.what()), 1;
    }
    return 0;
}
