#include "geometry/mesh.h"

#include "support/meshes.h"

#include <gtest/gtest.h>
#include <limits>

namespace toile::geometry {
namespace {

TopologyReport check(const TriangleMesh& mesh) {
    return check_topology(mesh.positions, mesh.triangles);
}

TEST(Topology, ABoxIsClosed) {
    const TopologyReport report = check(test::box(Vec3f::Zero(), Vec3f(1, 2, 3)));
    EXPECT_TRUE(report.closed()) << report.text();
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.text(), "");
}

TEST(Topology, BordersAreManifoldButNotClosed) {
    const TopologyReport report = check(test::tube(1, 1, 1, 12, 3));
    EXPECT_TRUE(report.manifold()) << report.text();
    EXPECT_EQ(report.boundary_edges, 24u);
}

TEST(Topology, EachFaultIsCounted) {
    const TriangleMesh good = test::box(Vec3f::Zero(), Vec3f::Ones());

    TriangleMesh mesh = good;
    mesh.triangles[3][1] = 99;
    EXPECT_EQ(check(mesh).out_of_range, 1u);
    EXPECT_FALSE(check(mesh).usable());

    mesh = good;
    mesh.positions[2].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(check(mesh).non_finite, 1u);

    mesh = good;
    mesh.triangles.push_back({1, 1, 2});
    EXPECT_EQ(check(mesh).degenerate, 1u);

    mesh = good;
    std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
    EXPECT_EQ(check(mesh).misoriented_edges, 3u);

    mesh = good;
    mesh.positions.emplace_back(0.5f, 0.5f, 2.0f);
    mesh.triangles.push_back({0, 1, 8});
    EXPECT_EQ(check(mesh).non_manifold_edges, 1u);
    EXPECT_NE(check(mesh).text(), "");

    mesh = good;
    mesh.positions.emplace_back(5.0f, 5.0f, 5.0f);
    EXPECT_EQ(check(mesh).unused_vertices, 1u);
    EXPECT_TRUE(check(mesh).manifold());
}

TEST(Topology, TwoFansAtOneVertexAreNotManifold) {
    TriangleMesh mesh; // a bow tie
    mesh.positions = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0), Vec3f(-1, 0, 0),
                      Vec3f(-1, -1, 0)};
    mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
    const TopologyReport report = check(mesh);
    EXPECT_EQ(report.non_manifold_vertices, 1u);
    EXPECT_EQ(report.components, 2u);
    EXPECT_TRUE(report.usable());
    EXPECT_FALSE(report.manifold());
}

TEST(Mesh, AreaAndVolumeOfABox) {
    const TriangleMesh mesh = test::box(Vec3f(-1, 0, 2), Vec3f(0, 2, 5));
    EXPECT_NEAR(surface_area(mesh), 2 * (1 * 2 + 2 * 3 + 3 * 1), 1e-6);
    EXPECT_NEAR(volume(mesh), 6.0, 1e-6);
}

TEST(Mesh, SphereNormalsPointOutwards) {
    const TriangleMesh mesh = test::sphere(0.5f, 4);
    EXPECT_TRUE(check(mesh).closed());
    EXPECT_GT(volume(mesh), 0.0);
    std::vector<Vec3f> normals(mesh.positions.size());
    vertex_normals(mesh.positions, mesh.triangles, normals);
    for (std::size_t i = 0; i < normals.size(); ++i)
        EXPECT_GT(normals[i].dot(mesh.positions[i].normalized()), 0.995f);
}

TEST(Mesh, AdjacencyIsSortedAndSymmetric) {
    const TriangleMesh mesh = test::sphere(1.0f, 2);
    const VertexAdjacency vv = vertex_adjacency(mesh.positions.size(), mesh.triangles);
    // Closed genus 0: V - E + F = 2.
    EXPECT_EQ(mesh.positions.size() - vv.neighbours.size() / 2 + mesh.triangles.size(), 2u);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const std::span row(vv.neighbours.data() + vv.first[v], vv.first[v + 1] - vv.first[v]);
        EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
        for (const std::uint32_t w : row) {
            const auto begin = vv.neighbours.begin() + vv.first[w];
            const auto end = vv.neighbours.begin() + vv.first[w + 1];
            EXPECT_TRUE(std::binary_search(begin, end, v));
        }
    }
    const VertexAdjacency vf = vertex_triangles(mesh.positions.size(), mesh.triangles);
    EXPECT_EQ(vf.neighbours.size(), 3 * mesh.triangles.size());
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
        for (std::uint32_t i = vf.first[v]; i < vf.first[v + 1]; ++i) {
            const Triangle& t = mesh.triangles[vf.neighbours[i]];
            EXPECT_TRUE(t[0] == v || t[1] == v || t[2] == v);
        }
}

TEST(Weld, SeamsCloseAndTheLayoutLeadsBack) {
    // A box with three vertices of its own per triangle.
    const TriangleMesh box = test::box(Vec3f::Zero(), Vec3f::Ones());
    std::vector<Vec3f> positions;
    std::vector<Vec2f> texcoords;
    std::vector<Triangle> triangles;
    for (const Triangle& t : box.triangles) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const std::uint32_t v : t) {
            positions.push_back(box.positions[v]);
            texcoords.emplace_back(static_cast<float>(positions.size()), 0.0f);
        }
        triangles.push_back({first, first + 1, first + 2});
    }
    positions[0].x() = -0.0f; // the same place as 0

    SeamedLayout layout;
    const TriangleMesh welded = weld(positions, triangles, texcoords, layout);
    EXPECT_EQ(welded.positions.size(), 8u);
    EXPECT_TRUE(check(welded).closed());
    ASSERT_EQ(layout.welded.size(), 36u);
    EXPECT_EQ(layout.texcoords, texcoords);
    for (std::size_t i = 0; i < positions.size(); ++i)
        EXPECT_EQ(welded.positions[layout.welded[i]], positions[i]);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(welded.triangles[i][k], layout.welded[layout.triangles[i][k]]);
}

} // namespace
} // namespace toile::geometry
