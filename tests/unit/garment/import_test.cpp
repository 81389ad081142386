#include "garment/import.h"

#include "assets/files.h"
#include "garment/flatten.h"
#include "garment/mend.h"
#include "support/figure.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>

namespace toile::garment {
namespace {

namespace fs = std::filesystem;

/// The figure's shirt as a file in some unit, moved and turned.
fs::path shirt_file(const test::TemporaryFolder& folder, const Eigen::Affine3f& move) {
    static const test::Figure figure = test::figure();
    const geometry::TriangleMesh shirt = test::shirt_on(figure, 0.012f, 0.03f);
    assets::Primitive p;
    for (const Vec3f& x : shirt.positions)
        p.positions.push_back(move * x);
    p.triangles = shirt.triangles;
    assets::Scene scene;
    scene.meshes.emplace_back();
    scene.meshes[0].name = "shirt";
    scene.meshes[0].primitives.push_back(p);
    assets::Node node;
    node.name = "shirt";
    node.mesh = 0;
    scene.nodes.push_back(node);
    assets::save_scene(scene, folder / "shirt.obj");
    return folder / "shirt.obj";
}

ImportOptions options() {
    ImportOptions out;
    out.id = "shirt";
    out.kind = "t-shirt";
    return out;
}

double worst_edge_error(const GarmentSize& size) {
    double worst = 0.0;
    for (std::size_t i = 0; i < size.simulation.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Triangle& t = size.simulation.triangles[i];
            const double truth = static_cast<double>(
                (size.simulation.positions[t[k]] - size.simulation.positions[t[(k + 1) % 3]])
                    .norm());
            const double flat = static_cast<double>(
                (size.material_coords[3 * i + k] - size.material_coords[3 * i + (k + 1) % 3])
                    .norm());
            worst = std::max(worst, std::abs(flat - truth) / std::max(truth, 1e-3));
        }
    return worst;
}

TEST(Import, FindsUnitAxesAndPlace) {
    const test::Figure figure = test::figure();
    body::BodyModel body;
    body.rest = figure.mesh;
    struct Case {
        Unit unit;
        bool z_up;
        Vec3f shift;
    };
    for (const Case& c :
         {Case{Unit::metres, false, Vec3f::Zero()}, Case{Unit::centimetres, false, Vec3f::Zero()},
          Case{Unit::decimetres, false, Vec3f(0.0f, -0.82f, 0.03f)},
          Case{Unit::millimetres, true, Vec3f::Zero()}}) {
        Eigen::Affine3f move = Eigen::Affine3f::Identity();
        move.scale(static_cast<float>(1.0 / metres_per(c.unit)));
        if (c.z_up)
            move.rotate(Eigen::AngleAxisf(0.5f * std::numbers::pi_v<float>, Vec3f::UnitX()));
        move.translate(c.shift);
        const test::TemporaryFolder folder;
        const Import import = import_garment(shirt_file(folder, move), options(), &body);
        const auto& mesh = import.package.sizes[0].simulation;
        const auto truth = test::shirt_on(figure, 0.012f, 0.03f);
        ASSERT_EQ(mesh.triangles.size(), truth.triangles.size());
        Vec3f mean = Vec3f::Zero();
        Vec3f wanted = Vec3f::Zero();
        for (const Vec3f& p : mesh.positions)
            mean += p / static_cast<float>(mesh.positions.size());
        for (const Vec3f& p : truth.positions)
            wanted += p / static_cast<float>(truth.positions.size());
        EXPECT_LT((mean - wanted).norm(), 0.03f) << unit_name(c.unit);
        const test::TemporaryFolder out;
        write_package(import.package, out.path());
        const Faults faults = check_package(out.path());
        EXPECT_TRUE(faults.empty()) << faults.front().text;
        EXPECT_LT(worst_edge_error(import.package.sizes[0]), 0.06);
    }
}

TEST(Mend, TurnsMergesAndCuts) {
    // Two quads side by side, one turned over, a vertex doubled, and a third wing on the middle.
    const std::vector<Vec3f> p = {{0, 0, 0}, {1, 0, 0},     {1, 1, 0}, {0, 1, 0},
                                  {2, 0, 0}, {2, 1, 1e-5f}, {2, 1, 0}, {1, 0, 1}};
    const std::vector<Triangle> t = {{0, 1, 2}, {0, 2, 3}, {1, 2, 4}, {2, 4, 5},
                                     {1, 2, 7}, {0, 1, 2}, {4, 5, 6}};
    const MendedMesh out = mend(p, t);
    EXPECT_EQ(out.merged_vertices, 1u);
    EXPECT_EQ(out.dropped_triangles, 2u); // the one twice and the one without area
    EXPECT_GE(out.cut_edges, 1u);
    EXPECT_TRUE(geometry::check_topology(out.mesh.positions, out.mesh.triangles).manifold());
    geometry::SeamedLayout layout;
    const auto welded = geometry::weld(out.mesh.positions, out.mesh.triangles, {}, layout);
    EXPECT_EQ(welded.positions.size(), out.mesh.positions.size()); // welding undoes nothing
}

TEST(Flatten, ACylinderKeepsItsLengths) {
    const GarmentSize tube = [] {
        const auto mesh = test::skirt_on(0.175f, 48, 20);
        GarmentSize size;
        size.simulation = mesh;
        size.material_coords = flatten(mesh, {}).coords;
        return size;
    }();
    EXPECT_LT(worst_edge_error(tube), 0.051);
    const Flattening flat = flatten(tube.simulation, {});
    EXPECT_LT(flat.mean_strain, 0.01);
    EXPECT_GE(flat.charts, 2u);
    // The warp runs up: a vertical edge has its length along v.
    const Triangle& t = tube.simulation.triangles[1];
    const Vec2f d = flat.coords[5] - flat.coords[3];
    EXPECT_GT(tube.simulation.positions[t[2]].y() - tube.simulation.positions[t[0]].y(), 0.02f);
    EXPECT_GT(d.y(), 0.9f * d.norm());
}

TEST(Import, ArtistsGarmentsBecomeSoundPackages) {
    TOILE_SHARED_DATA_OR_SKIP(clothes, "makehuman_clothes_cc0");
    TOILE_SHARED_DATA_OR_SKIP(scene, "cloth_scene");
    geometry::SeamedLayout layout;
    const auto body_scene = assets::load_scene(scene / "body.obj");
    const auto& primitive = body_scene.meshes[0].primitives[0];
    body::BodyModel body;
    body.rest = geometry::weld(primitive.positions, primitive.triangles, {}, layout);
    for (Vec3f& p : body.rest.positions)
        p.y() += 0.81676f; // on the floor
    std::size_t count = 0;
    for (const char* const name : {"female_casualsuit01", "female_elegantsuit01",
                                   "male_casualsuit05", "male_worksuit01", "shoes03", "fedora01"}) {
        const fs::path folder = clothes / "base" / "clothes" / name;
        const std::string file = std::string(name) == "fedora01" ? "fedora" : name;
        ImportOptions o = options();
        o.id = name;
        const Import import = import_garment(folder / (file + ".obj"), o, &body);
        const test::TemporaryFolder out;
        write_package(import.package, out.path());
        const Faults faults = check_package(out.path());
        EXPECT_TRUE(faults.empty()) << faults.front().text;
        EXPECT_LT(worst_edge_error(import.package.sizes[0]), 0.06) << name;
        std::printf("%s\n", name);
        for (const std::string& finding : import.findings)
            std::printf("    %s\n", finding.c_str());
        ++count;
    }
    EXPECT_EQ(count, 6u);
}

TEST(Import, SaysWhatIsWrong) {
    const test::TemporaryFolder folder;
    ImportOptions o = options();
    o.id = "No Good";
    EXPECT_ERROR(static_cast<void>(import_garment(folder / "none.obj", o, nullptr)), "the id");
    EXPECT_ERROR(static_cast<void>(import_garment(folder / "none.obj", options(), nullptr)),
                 "none.obj");
}

} // namespace
} // namespace toile::garment
