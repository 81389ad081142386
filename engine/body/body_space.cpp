#include "body/body_space.h"

#include "body/table_file.h"
#include "core/json.h"
#include "geometry/laplacian.h"
#include "geometry/nearest_surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

namespace toile::body {
namespace {

constexpr std::int64_t kSchema = 1;
constexpr double kFarthest = 100.0; // deviations; beyond, a file is broken
constexpr std::size_t kMaxLevels = 8;
constexpr int kMaxComponents = 1000;

Eigen::VectorXd read_vector(JsonObject& object, const std::string& key, int size) {
    const auto values = object.numbers(key, static_cast<std::size_t>(size));
    for (const double v : values)
        if (std::abs(v) > kFarthest) throw object.error(key, "has a value beyond 100 deviations");
    return Eigen::Map<const Eigen::VectorXd>(values.data(), size);
}

CoefficientPrior read_prior(JsonObject object, int k) {
    CoefficientPrior out;
    out.mean = read_vector(object, "mean", k);
    const Eigen::VectorXd flat = read_vector(object, "covariance", k * k);
    object.finish();
    out.covariance = Eigen::Map<const Eigen::MatrixXd>(flat.data(), k, k);
    if (!out.covariance.isApprox(out.covariance.transpose(), 1e-6) ||
        out.covariance.llt().info() != Eigen::Success)
        throw object.error("covariance", "is not symmetric and positive definite");
    return out;
}

std::vector<Vec3f> picked(const geometry::TriangleMesh& mesh,
                          std::span<const std::uint32_t> vertices) {
    std::vector<Vec3f> out;
    out.reserve(vertices.size());
    for (const auto v : vertices)
        out.push_back(mesh.positions[v]);
    return out;
}

BodyLevel read_level(const TableReader& tables, const std::string& name,
                     const geometry::TriangleMesh& full, const std::string& file) {
    const auto nv = static_cast<std::uint32_t>(full.positions.size());
    auto vertices = tables.integers(name + "_vertices", nv);
    const auto corners =
        tables.integers(name + "_triangles", static_cast<std::uint32_t>(vertices.size()));
    if (corners.empty() || corners.size() % 3 != 0)
        throw FileError(file, "table '" + name + "_triangles' has no whole triangles");
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < corners.size(); i += 3)
        triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    if (!geometry::check_topology(picked(full, vertices), triangles).closed())
        throw FileError(file, "level '" + name + "' is not closed");
    return make_level(full, std::move(vertices), std::move(triangles));
}

float floor_of(std::span<const Vec3f> positions) {
    float floor = std::numeric_limits<float>::max();
    for (const auto& p : positions)
        floor = std::min(floor, p.y());
    return floor;
}

} // namespace

BodySpace BodySpace::load(const std::filesystem::path& folder) {
    BodySpace out;
    out.model_ = load_body_model(folder);
    const std::filesystem::path json_file = folder / "space.json";
    const nlohmann::json json = parse_json_file(json_file);
    JsonObject space(json, json_file.string());
    space.integer("schema", kSchema, kSchema);
    const int k = out.component_count();
    if (k == 0) throw space.error("", "stands beside a model without shape components");
    if (k > kMaxComponents) throw space.error("", "stands beside a model of too many components");
    JsonObject priors = space.object("coefficients");
    for (std::size_t s = 0; s < kSexes.size(); ++s)
        out.priors_[s] = read_prior(priors.object(sex_name(kSexes[s])), k);
    priors.finish();
    const auto levels = space.texts("levels");
    if (levels.size() > kMaxLevels) throw space.error("levels", "names too many levels");
    const std::filesystem::path tables_file = folder / space.file_name("tables");
    space.finish();

    const TableReader tables(tables_file);
    for (const auto& level : levels)
        out.levels_.push_back(read_level(tables, level, out.model_.rest, tables_file.string()));

    const auto nv = static_cast<int>(out.model_.rest.positions.size());
    out.offsets_.resize(3 * nv + 3 * static_cast<int>(kJointCount), k);
    for (int c = 0; c < k; ++c) {
        const ShapeComponent& component = out.model_.shape[static_cast<std::size_t>(c)];
        for (int v = 0; v < nv; ++v)
            out.offsets_.col(c).segment<3>(3 * v) =
                component.vertex_offsets[static_cast<std::size_t>(v)];
        for (std::size_t j = 0; j < kJointCount; ++j)
            out.offsets_.col(c).segment<3>(3 * nv + 3 * static_cast<int>(j)) =
                component.joint_offsets[j];
    }
    out.area_ = geometry::lumped_mass(out.model_.rest.positions, out.model_.rest.triangles,
                                      geometry::MassKind::barycentric)
                    .cast<float>();
    return out;
}

const CoefficientPrior& BodySpace::prior(Sex sex) const {
    if (sex == Sex::invalid) throw Error("a prior is asked for without a sex");
    return priors_[sex == kSexes[0] ? 0 : 1];
}

BodyShape BodySpace::shape(std::span<const double> coefficients) const {
    if (coefficients.size() > model_.shape.size())
        throw Error(std::to_string(coefficients.size()) + " shape coefficients given; '" +
                    model_.id + "' has " + std::to_string(model_.shape.size()));
    const auto nv = model_.rest.positions.size();
    const auto used = static_cast<int>(coefficients.size());
    const Eigen::VectorXf moved =
        offsets_.leftCols(used) *
        Eigen::Map<const Eigen::VectorXd>(coefficients.data(), used).cast<float>();
    BodyShape out;
    out.positions.resize(nv);
    for (std::size_t v = 0; v < nv; ++v)
        out.positions[v] = model_.rest.positions[v] + moved.segment<3>(3 * static_cast<int>(v));
    const float floor = floor_of(out.positions);
    for (auto& p : out.positions)
        p.y() -= floor;
    for (std::size_t j = 0; j < kJointCount; ++j) {
        out.skeleton.rest_positions[j] =
            model_.skeleton.rest_positions[j] + moved.segment<3>(3 * static_cast<int>(nv + j));
        out.skeleton.rest_positions[j].y() -= floor;
    }
    return out;
}

Eigen::VectorXd BodySpace::coefficients(std::span<const Vec3f> positions) const {
    const auto nv = static_cast<int>(model_.rest.positions.size());
    if (positions.size() != model_.rest.positions.size())
        throw Error("a surface of " + std::to_string(positions.size()) +
                    " vertices is not on the topology of '" + model_.id + "'");
    // One more unknown: the height that the floor took off.
    const int k = component_count();
    Eigen::MatrixXf basis(3 * nv, k + 1);
    basis.leftCols(k) = offsets_.topRows(3 * nv);
    basis.col(k).setZero();
    Eigen::VectorXf difference(3 * nv), weight(3 * nv);
    for (int v = 0; v < nv; ++v) {
        const auto i = static_cast<std::size_t>(v);
        difference.segment<3>(3 * v) = positions[i] - model_.rest.positions[i];
        weight.segment<3>(3 * v).setConstant(area_[v]);
        basis(3 * v + 1, k) = 1.0f;
    }
    const Eigen::MatrixXf weighted = weight.asDiagonal() * basis;
    const Eigen::MatrixXd normal = (basis.transpose() * weighted).cast<double>();
    const Eigen::VectorXd right = (weighted.transpose() * difference).cast<double>();
    return normal.ldlt().solve(right).head(k);
}

BodyModel BodySpace::body(std::span<const double> coefficients) const {
    BodyModel out = model_;
    BodyShape made = shape(coefficients);
    out.rest.positions = std::move(made.positions);
    geometry::vertex_normals(out.rest.positions, out.rest.triangles, out.rest.normals);
    out.skeleton = made.skeleton;
    out.measurements.clear();
    out.shape.clear();
    return out;
}

BodyLevel make_level(const geometry::TriangleMesh& full, std::vector<std::uint32_t> vertices,
                     std::vector<Triangle> triangles) {
    BodyLevel out;
    out.vertices = std::move(vertices);
    out.triangles = std::move(triangles);
    const geometry::NearestSurface nearest(picked(full, out.vertices), out.triangles);
    for (const auto& p : full.positions) {
        const auto hit = nearest.nearest(p);
        out.triangle.push_back(hit.triangle);
        out.barycentric.push_back(hit.barycentric);
    }
    return out;
}

} // namespace toile::body
