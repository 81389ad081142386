#include "garment/package_checks.h"

#include "garment/embedding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace toile::garment {
namespace {

constexpr double kLeastArea = 1e-9; ///< m^2 of a triangle; 0.03 mm x 0.06 mm

std::string millimetres(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f mm", 1000.0 * metres);
    return text.data();
}

std::string metres(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g m", value);
    return text.data();
}

double area_in_space(const GarmentSize& size, std::size_t triangle) {
    const Triangle& t = size.simulation.triangles[triangle];
    const Vec3d a = size.simulation.positions[t[0]].cast<double>();
    const Vec3d b = size.simulation.positions[t[1]].cast<double>();
    const Vec3d c = size.simulation.positions[t[2]].cast<double>();
    return 0.5 * (b - a).cross(c - a).norm();
}

double area_of_material(const GarmentSize& size, std::size_t triangle) {
    const Vec2f* const m = size.material_coords.data() + 3 * triangle;
    const Eigen::Vector2d a = (m[1] - m[0]).cast<double>();
    const Eigen::Vector2d b = (m[2] - m[0]).cast<double>();
    return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

void check_areas(const GarmentSize& size, const std::string& shown, Faults& faults) {
    double space = 0.0;
    double material = 0.0;
    std::size_t flat = 0;
    std::size_t first_flat = 0;
    for (std::size_t i = size.simulation.triangles.size(); i-- > 0;) {
        const double area = area_of_material(size, i);
        if (!std::isfinite(area) || area < kLeastArea) {
            ++flat;
            first_flat = i;
        }
        material += area;
        space += area_in_space(size, i);
    }
    if (flat > 0)
        faults.push_back({FaultCode::material_coords,
                          shown + ": the material coordinates of " + std::to_string(flat) +
                              " triangles have no area, first of triangle " +
                              std::to_string(first_flat) +
                              "; `toile garment new` makes sound ones"});
    else if (!(material > 0.15 * space && material < 6.0 * space))
        faults.push_back(
            {FaultCode::material_coords,
             shown + ": the material coordinates cover " + metres(material) + "2 but the mesh " +
                 metres(space) +
                 "2; they must be in metres (texture coordinates are not): `toile garment new`"});
}

void check_skin(const body::SkinWeights& skin, const std::string& shown, Faults& faults) {
    for (std::size_t v = 0; v < skin.weights.size(); ++v) {
        float sum = 0.0f;
        for (const float w : skin.weights[v])
            sum += w;
        if (std::abs(sum - 1.0f) < 1e-3f) continue;
        faults.push_back({FaultCode::skin, shown + ": the skin weights of vertex " +
                                               std::to_string(v) + " do not sum to 1"});
        return;
    }
}

struct Bounds {
    Eigen::AlignedBox3d box;
    explicit Bounds(std::span<const Vec3f> positions) {
        for (const Vec3f& p : positions)
            box.extend(p.cast<double>());
    }
};

/// The unit in which a thing of this extent would fit a person, or "".
std::string likely_unit(double extent, double wanted) {
    struct Unit {
        const char* name;
        double metres;
    };
    static constexpr std::array<Unit, 3> kUnits = {
        {{"decimetres", 0.1}, {"centimetres", 0.01}, {"millimetres", 0.001}}};
    const Unit* best = nullptr;
    for (const Unit& unit : kUnits)
        if (best == nullptr || std::abs(std::log(extent * unit.metres / wanted)) <
                                   std::abs(std::log(extent * best->metres / wanted)))
            best = &unit;
    std::array<char, 120> text{};
    std::snprintf(text.data(), text.size(),
                  "its unit looks like %s: multiply by %g, or start with `toile garment new`",
                  best->name, best->metres);
    return text.data();
}

} // namespace

void check_simulation(const GarmentSize& size, const std::string& shown,
                      const PackageLimits& limits, Faults& faults) {
    const auto& mesh = size.simulation;
    if (mesh.positions.size() > limits.max_vertices) {
        faults.push_back(
            {FaultCode::mesh, shown + ": the simulation mesh has " +
                                  std::to_string(mesh.positions.size()) + " vertices, at most " +
                                  std::to_string(limits.max_vertices) + " can be used"});
        return;
    }
    const auto report = geometry::check_topology(mesh.positions, mesh.triangles);
    if (!report.usable() || report.unused_vertices > 0) {
        const std::string what = !report.usable() ? report.text()
                                                  : std::to_string(report.unused_vertices) +
                                                        " vertices belong to no triangle";
        faults.push_back({FaultCode::mesh, shown + ": simulation mesh: " + what});
    } else if (!report.manifold()) {
        faults.push_back({FaultCode::topology,
                          shown + ": the welded simulation mesh is not a manifold surface: " +
                              report.text() + "; `toile garment new` mends it"});
    }
    if (report.usable()) check_areas(size, shown, faults);
    check_skin(size.skin, shown, faults);
}

void check_unit(const GarmentSize& size, const std::string& shown,
                const geometry::TriangleMesh* body, Faults& faults) {
    const Bounds garment(size.simulation.positions);
    const double extent = garment.box.sizes().maxCoeff();
    double person = 1.75;
    Eigen::AlignedBox3d around(Vec3d(-1.2, -0.1, -0.8), Vec3d(1.2, 2.4, 0.8));
    if (body != nullptr) {
        const Bounds bounds(body->positions);
        person = bounds.box.sizes().maxCoeff();
        around = {bounds.box.min() - Vec3d::Constant(0.3), bounds.box.max() + Vec3d::Constant(0.3)};
    }
    if (extent > 1.6 * person || extent < 0.03 * person) {
        faults.push_back({FaultCode::unit, shown + ": the mesh is " + metres(extent) +
                                               " large, a person " + metres(person) + "; " +
                                               likely_unit(extent, 0.5 * person)});
    } else if (!around.contains(garment.box)) {
        const Vec3d c = garment.box.center();
        std::array<char, 96> text{};
        std::snprintf(text.data(), text.size(), "(%.2f, %.2f, %.2f) m", c.x(), c.y(), c.z());
        faults.push_back({FaultCode::unit, shown +
                                               ": the mesh stands apart from the body it was "
                                               "made on, with its middle at " +
                                               text.data() +
                                               "; +Y is up and the floor at 0: `toile garment "
                                               "new` moves it"});
    }
}

void check_render(const GarmentSize& size, const std::string& shown, const PackageLimits& limits,
                  Faults& faults) {
    const SurfaceEmbedding embedding(size);
    const auto& parts = embedding.parts();
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!(parts[i].max_distance <= limits.max_render_distance))
            faults.push_back({FaultCode::render_far,
                              shown + ": render mesh '" + size.render.meshes[parts[i].mesh].name +
                                  "' lies " + millimetres(parts[i].max_distance) +
                                  " off the simulation mesh, at most " +
                                  millimetres(limits.max_render_distance) + " are allowed"});
}

void check_across_sizes(GarmentPackage& package, const std::string& shown, Faults& faults) {
    if (package.sizes.empty()) return;
    const GarmentSize& first = package.sizes.front();
    for (const GarmentSize& size : package.sizes) {
        const bool same = size.simulation.triangles == first.simulation.triangles &&
                          size.simulation.positions.size() == first.simulation.positions.size();
        if (!same)
            faults.push_back({FaultCode::size_topology,
                              shown + ": sizes '" + first.entry.name + "' and '" + size.entry.name +
                                  "' have simulation meshes with different triangles; all sizes of "
                                  "a design share one topology"});
        bool render = size.render.meshes.size() == first.render.meshes.size();
        for (std::size_t m = 0; render && m < size.render.meshes.size(); ++m) {
            const auto& a = size.render.meshes[m].primitives;
            const auto& b = first.render.meshes[m].primitives;
            render = a.size() == b.size() &&
                     std::equal(a.begin(), a.end(), b.begin(), [](const auto& p, const auto& q) {
                         return p.triangles == q.triangles;
                     });
        }
        if (!render)
            faults.push_back({FaultCode::size_topology, shown + ": sizes '" + first.entry.name +
                                                            "' and '" + size.entry.name +
                                                            "' have different render meshes"});
        for (const Variant& variant : package.manifest.variants) {
            const auto& known = size.render.variants;
            if (!variant.material_variant.empty() &&
                std::find(known.begin(), known.end(), variant.material_variant) == known.end())
                faults.push_back({FaultCode::variant, shown + ": /variants: size '" +
                                                          size.entry.name +
                                                          "' has no material variant '" +
                                                          variant.material_variant + "'"});
        }
    }
    const std::size_t nv = first.simulation.positions.size();
    for (const PinGroup& group : package.manifest.pins) {
        const auto refuse = [&](const std::string& what) {
            faults.push_back({FaultCode::pins, shown + ": /pins: '" + group.name + "' " + what});
        };
        const auto beyond = std::find_if(group.vertices.begin(), group.vertices.end(),
                                         [nv](std::uint32_t v) { return v >= nv; });
        if (beyond != group.vertices.end()) {
            refuse("names vertex " + std::to_string(*beyond) + ", but the simulation mesh has " +
                   std::to_string(nv));
        } else if (!group.mask.empty() && group.mask.size() != nv) {
            refuse("has a mask of " + std::to_string(group.mask.size()) +
                   " numbers, but the simulation mesh has " + std::to_string(nv) + " vertices");
        } else {
            package.pins.resize(nv, 0.0f);
            for (const std::uint32_t v : group.vertices)
                package.pins[v] = std::max(package.pins[v], group.strength);
            for (std::size_t v = 0; v < group.mask.size(); ++v)
                package.pins[v] = std::max(package.pins[v], group.mask[v]);
        }
    }
}

} // namespace toile::garment
