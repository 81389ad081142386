// What lies on a body follows it: room kept, no folds, rigid moves exact.
#include "laplace_beltrami_resize/follow_body.h"

#include "bodies.h"
#include "geometry/nearest_surface.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <iostream>

namespace toile::laplace_beltrami_resize {
namespace {

/// The body's own surface, `room` metres outside of it.
geometry::TriangleMesh around(const geometry::TriangleMesh& body, float room) {
    geometry::TriangleMesh out = body;
    std::vector<Vec3f> normals(body.positions.size());
    geometry::vertex_normals(body.positions, body.triangles, normals);
    for (std::size_t v = 0; v < normals.size(); ++v)
        out.positions[v] += room * normals[v];
    return out;
}

TEST(FollowBody, RigidMovesAreExactOnTheSkin) {
    const auto body = person(0);
    auto moved = body;
    const Mat3f turn = Eigen::AngleAxisf(0.6f, Vec3f(0.2f, 1.0f, 0.1f).normalized()).matrix();
    for (Vec3f& p : moved.positions)
        p = turn * p + Vec3f(0.3f, 0.1f, -0.5f);
    const auto followed = follow_body(body, body, moved.positions, &serial_rows);
    for (std::size_t v = 0; v < followed.size(); ++v)
        EXPECT_LT((followed[v] - moved.positions[v]).norm(), 0.003f);
}

TEST(FollowBody, AGarmentKeepsItsRoomOnAnotherBody) {
    const auto mannequin = person(0);
    for (const std::uint64_t customer : {1u, 2u, 4u}) {
        const auto other = person(customer);
        const auto garment = around(mannequin, 0.02f);
        const geometry::NearestSurface before(mannequin.positions, mannequin.triangles);
        const auto followed = follow_body(garment, mannequin, other.positions, &serial_rows);
        const geometry::NearestSurface after(other.positions, other.triangles);
        std::vector<float> changes;
        for (std::size_t v = 0; v < followed.size(); ++v)
            changes.push_back(std::abs(after.nearest(followed[v]).signed_distance -
                                       before.nearest(garment.positions[v]).signed_distance));
        std::sort(changes.begin(), changes.end());
        EXPECT_LT(changes[changes.size() * 99 / 100], 0.01f) << "customer " << customer;
        std::cout << "customer " << customer << ": room changes by "
                  << 1000.0f * changes[changes.size() / 2] << " mm (median), "
                  << 1000.0f * changes[changes.size() * 99 / 100] << " mm (p99)\n";
    }
}

TEST(FollowBody, ThreadsDoNotMatter) {
    const auto mannequin = person(0), other = person(2);
    const RowLoop backwards = [](std::uint32_t count, std::uint32_t grain, const auto& work) {
        const std::uint32_t ranges = (count + grain - 1) / grain;
        for (std::uint32_t r = ranges; r-- > 0;)
            work(r * grain, std::min(count, (r + 1) * grain));
    };
    const auto garment = around(mannequin, 0.03f);
    EXPECT_EQ(follow_body(garment, mannequin, other.positions, &serial_rows),
              follow_body(garment, mannequin, other.positions, backwards));
}

TEST(FollowBody, BodiesMustBeOfOneTopology) {
    const auto body = person(0);
    std::vector<Vec3f> fewer(body.positions.begin(), body.positions.end() - 1);
    EXPECT_ERROR((void)follow_body(body, body, fewer, &serial_rows), "vertices");
}

} // namespace
} // namespace toile::laplace_beltrami_resize
