// The weight of the shape's prior (P5 eq. 23), learned as P5 4.1 proposes: people whose shape is
// known are seen by simulated cameras, and the weight is the one with which their fits would come
// closest to it.
//
//     shape_weight_evaluation MODEL_FOLDER [--people N] [--views 4|1] [--noise none|usual|full]
//         [--json FILE]
//
// Around the true state the fit's step is linear: with H and g of what was seen (pose and cameras
// eliminated) and P, m of the population, a weight w moves the coefficients by
// -(H + w P)^-1 (g + w P (b - m)). The error is taken over the surface, metres.
#include "body/joint_limits.h"
#include "body/rotations.h"
#include "core/random.h"
#include "evaluation/simulated_views.h"
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

constexpr std::size_t kLevel = 1; // 3,000 vertices

struct Settings {
    fs::path model, json;
    int people = 24, views = 4;
    std::string noise = "full";
};

/// Somebody of a sex' population in a relaxed pose.
fit::FitState somebody(const fit::FitModel& model, body::Sex sex, toile::Random& random) {
    fit::FitState out;
    const body::CoefficientPrior& prior = model.space().prior(sex);
    Eigen::VectorXd normal(prior.mean.size());
    for (double& n : normal)
        n = random.normal();
    out.shape.coefficients = prior.mean + prior.covariance.llt().matrixL() * normal;
    body::Pose& pose = out.poses.emplace_back();
    const body::Skeleton skeleton = model.skeleton(out.shape.coefficients);
    const auto turn = [&](body::Joint joint, const Vec3f& share) {
        pose.rotations[static_cast<std::size_t>(joint)] =
            body::from_rotation_vector(body::limited_rotation(skeleton, joint, share));
    };
    turn(body::Joint::left_upper_arm, Vec3f(0.0f, 0.0f, -0.5f));
    turn(body::Joint::right_upper_arm, Vec3f(0.0f, 0.0f, -0.5f));
    turn(body::Joint::left_upper_leg, Vec3f(0.0f, 0.0f, 0.1f));
    turn(body::Joint::right_upper_leg, Vec3f(0.0f, 0.0f, 0.1f));
    pose.hips_position = Vec3f::Zero();
    fit::PosedLevel posed;
    fit::pose_level(model, model.level(0), out.shape, pose, posed);
    float low = 1e9f;
    for (const Vec3f& p : posed.positions)
        low = std::min(low, p.y());
    pose.hips_position.y() -= low;
    return out;
}

fit::ObservedPerson see(const Settings& settings, const fit::FitModel& model,
                        const fit::FitState& truth, std::uint64_t seed) {
    const fs::path file =
        fs::temp_directory_path() / ("toile_shape_weight_" + std::to_string(getpid()) + ".glb");
    fit::PosedLevel posed;
    fit::pose_level(model, model.level(0), truth.shape, truth.poses[0], posed);
    toile::geometry::TriangleMesh surface;
    surface.positions = posed.positions;
    surface.triangles = model.level(0).triangles;
    toile::assets::Scene scene;
    add_mesh(scene, surface, Vec3f::Constant(0.5f));
    toile::assets::save_scene(scene, file);
    sensor::Scenario scenario = empty_room();
    scenario.seed = seed;
    add_cameras(scenario, settings.views, settings.noise);
    sensor::PersonSettings person;
    person.kind = sensor::BodyKind::mesh;
    person.source = file;
    scenario.people.push_back(person);
    sensor::Simulator simulator(std::move(scenario), &rows_on_all_cores);
    simulator.show(0);
    auto out = observe(simulator, 0);
    fs::remove(file);
    if (!out.trouble.empty()) throw std::runtime_error("nobody was seen: " + out.trouble);
    return out;
}

/// What one person's pictures say of the shape, pose and cameras eliminated.
struct Evidence {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    Eigen::VectorXd off_mean;
    body::Sex sex = body::Sex::invalid;
};

class Learner {
  public:
    explicit Learner(const Settings& settings)
        : settings_(settings), model_(settings.model), solver_(model_) {
        const fit::FitLevel& level = model_.level(kLevel);
        Eigen::VectorXf area(3 * static_cast<int>(level.areas.size()));
        for (std::size_t v = 0; v < level.areas.size(); ++v)
            area.segment<3>(static_cast<int>(3 * v)).setConstant(level.areas[v]);
        const Eigen::MatrixXf weighted = area.asDiagonal() * level.components;
        metric_ = (level.components.transpose() * weighted).cast<double>() /
                  (static_cast<double>(area.sum()) / 3.0);
    }

    void add_person(body::Sex sex, std::uint64_t seed) {
        toile::Random random(seed);
        fit::FitState truth = somebody(model_, sex, random);
        const auto person = see(settings_, model_, truth, seed);
        const fit::FitLevel& level = model_.level(kLevel);
        fit::PosedLevel posed;
        fit::pose_level(model_, level, truth.shape, truth.poses[0], posed);
        fit::Associator associator(level);
        associator.set_surface(posed);
        fit::AssociationOptions pairing;
        pairing.along_rays = true;
        pairing.empty_weight = 0.0f;
        pairing.scale_m = 0.05f;
        truth.cameras.resize(static_cast<std::size_t>(settings_.views));
        std::vector<fit::Association> pairs(person.observations.size());
        std::vector<fit::AssociatedView> views;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const fit::ObservedPoints points(person.observations[i]);
            associator.associate(points, pairing, &rows_on_all_cores, pairs[i]);
            views.push_back({0, person.observations[i].camera, points.eye, &pairs[i]});
        }
        fit::FitPriors priors;
        priors.sex = sex;
        priors.shape_weight = 0.0;
        if (settings_.views > 1) priors.camera = fit::kCalibrated;
        solver_.linearise(level, {&posed, 1}, views, priors, &rows_on_all_cores, truth);
        const int k = model_.component_count();
        const Eigen::MatrixXd& all = solver_.normal_matrix();
        const int rest = static_cast<int>(all.rows()) - k;
        Eigen::MatrixXd others = all.bottomRightCorner(rest, rest);
        others.diagonal().array() += 1e-6;
        const Eigen::LDLT<Eigen::MatrixXd> solved(others);
        Evidence& out = evidence_.emplace_back();
        out.information = all.topLeftCorner(k, k) -
                          all.topRightCorner(k, rest) * solved.solve(all.bottomLeftCorner(rest, k));
        out.gradient = solver_.gradient().head(k) -
                       all.topRightCorner(k, rest) * solved.solve(solver_.gradient().tail(rest));
        out.off_mean = truth.shape.coefficients - model_.space().prior(sex).mean;
        out.sex = sex;
    }

    /// Root mean square of the surface's error with a weight, metres.
    [[nodiscard]] double error(double weight) const {
        double sum = 0.0;
        for (const Evidence& one : evidence_) {
            const Eigen::MatrixXd prior = weight * solver_.precision(one.sex);
            const Eigen::VectorXd off =
                -(one.information + prior).ldlt().solve(one.gradient + prior * one.off_mean);
            sum += off.dot(metric_ * off);
        }
        return std::sqrt(sum / static_cast<double>(evidence_.size()));
    }

  private:
    const Settings& settings_;
    fit::FitModel model_;
    fit::FitSolver solver_;
    Eigen::MatrixXd metric_; ///< mean squared move of the surface by coefficients
    std::vector<Evidence> evidence_;
};

void run(const Settings& settings) {
    Learner learner(settings);
    for (int i = 0; i < settings.people; ++i)
        learner.add_person(body::kSexes[static_cast<std::size_t>(i % 2)],
                           500 + static_cast<std::uint64_t>(i));
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    double best = 0.0, least = 1e9;
    for (int step = -16; step <= 4; ++step) {
        const double weight = std::pow(10.0, 0.25 * step);
        const double error = learner.error(weight);
        if (error < least) best = weight, least = error;
        rows.push_back({{"weight", weight}, {"surface_rms_mm", 1000.0 * error}});
        std::printf("%10.5f  %7.3f mm\n", weight, 1000.0 * error);
    }
    std::printf("best weight %.5f: %.3f mm\n", best, 1000.0 * least);
    if (!settings.json.empty()) std::ofstream(settings.json) << rows.dump(1) << "\n";
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Learns the weight of the shape's prior from simulated people");
    app.add_option("model", settings.model, "Folder of the body space")->required();
    app.add_option("--people", settings.people)->check(CLI::Range(1, 1000));
    app.add_option("--views", settings.views)->check(CLI::IsMember({1, 4}));
    app.add_option("--noise", settings.noise)->check(CLI::IsMember({"none", "usual", "full"}));
    app.add_option("--json", settings.json, "Gets all figures");
    CLI11_PARSE(app, argc, argv);
    try {
        run(settings);
    } catch (const std::exception& e) {
        return std::fprintf(stderr, "%s\n", e.what()), 1;
    }
    return 0;
}
