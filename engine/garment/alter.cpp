#include "garment/alter.h"

#include "core/error.h"
#include "garment/embedding.h"
#include "garment/flatten.h"

#include <Eigen/Dense>
#include <algorithm>

namespace toile::garment {
namespace {

using Mat2d = Eigen::Matrix2d;

Mat2d sides(std::span<const Vec2f> coords, std::size_t triangle) {
    Mat2d out;
    out << (coords[3 * triangle + 1] - coords[3 * triangle]).cast<double>(),
        (coords[3 * triangle + 2] - coords[3 * triangle]).cast<double>();
    return out;
}

void measure_change(std::span<const Vec2f> before, std::span<const Vec2f> after, Alteration& out) {
    double area = 0.0;
    double weft = 0.0;
    double warp = 0.0;
    for (std::size_t t = 0; 3 * t < before.size(); ++t) {
        const Mat2d old = sides(before, t);
        const Mat2d stretch = sides(after, t) * old.inverse();
        const double weight = 0.5 * std::abs(old.determinant());
        const Eigen::Vector2d s = Eigen::JacobiSVD<Mat2d>(stretch).singularValues();
        weft += weight * stretch.col(0).norm();
        warp += weight * stretch.col(1).norm();
        area += weight;
        out.most = std::max(out.most, s[0]);
        out.least = std::min(out.least, s[1]);
    }
    out.mean_weft = weft / area;
    out.mean_warp = warp / area;
}

void move_render(const GarmentSize& size, std::span<const Vec3f> carried, assets::Scene& render) {
    const SurfaceEmbedding embedding(size);
    SurfaceEmbedding::Scratch scratch = embedding.make_scratch();
    std::vector<Vec3f> normals(carried.size());
    geometry::vertex_normals(carried, size.simulation.triangles, normals);
    for (std::size_t i = 0; i < embedding.parts().size(); ++i) {
        const SurfaceEmbedding::Part& part = embedding.parts()[i];
        assets::Primitive& drawn = render.meshes[part.mesh].primitives[part.primitive];
        std::vector<Vec3f> its_normals(drawn.positions.size());
        embedding.evaluate(i, carried, normals, scratch, drawn.positions, its_normals);
        if (!drawn.normals.empty()) drawn.normals = std::move(its_normals);
    }
}

/// Ranges as wide as they were, around the body's own measurements.
std::map<std::string, ChartRange> chart_around(const std::map<std::string, ChartRange>& old,
                                               const std::map<std::string, double>& measurements) {
    std::map<std::string, ChartRange> out;
    for (const auto& [name, range] : old) {
        const auto own = measurements.find(name);
        if (own == measurements.end()) continue;
        const double half = 0.5 * (range.maximum - range.minimum);
        out[name] = {own->second - half, own->second + half};
    }
    return out;
}

} // namespace

Alteration alter(const GarmentPackage& package, const GarmentSize& size,
                 std::span<const Vec3f> carried, const AlterOptions& options) {
    if (carried.size() != size.simulation.positions.size())
        throw Error("garment " + package.manifest.id + ": " + std::to_string(carried.size()) +
                    " places for " + std::to_string(size.simulation.positions.size()) +
                    " vertices");
    Alteration out;
    out.package = package;
    Manifest& manifest = out.package.manifest;
    manifest.id = options.id;
    if (!options.name.empty()) manifest.name = options.name;
    manifest.made_on.clear();
    manifest.thumbnail.clear(); // it shows the old one
    GarmentSize made = size;
    made.entry.name = options.size_name;
    made.entry.mesh = options.id + ".glb";
    made.entry.render.clear();
    made.entry.made_on = options.made_on;
    made.entry.chart = chart_around(size.entry.chart, options.measurements);
    made.material_coords = flatten_carried(size.simulation, size.material_coords, carried);
    made.simulation.positions.assign(carried.begin(), carried.end());
    move_render(size, carried, made.render);
    measure_change(size.material_coords, made.material_coords, out);
    manifest.sizes = {made.entry};
    out.package.sizes = {std::move(made)};
    return out;
}

} // namespace toile::garment
