// Gaps between spheres are known.
#include "garment/skin_gap.h"

#include "core/error.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

namespace toile::garment {
namespace {

struct Body {
    geometry::TriangleMesh mesh = test::sphere(0.2f, 4);
    Body() {
        for (const Vec3f& p : mesh.positions)
            mesh.normals.push_back(p.normalized());
    }
    [[nodiscard]] SkinSurface skin() const { return {mesh.positions, mesh.normals}; }
};

TEST(SkinGap, IsTheDistanceToTheSkinNegativeInside) {
    const Body body;
    for (const float radius : {0.25f, 0.203f, 0.19f}) {
        const auto cloth = test::sphere(radius, 3);
        SkinGap gap(body.mesh.triangles, body.mesh.positions.size(), cloth.positions.size());
        gap.find(body.skin(), cloth.positions);
        for (const float g : gap.gaps())
            EXPECT_NEAR(g, radius - 0.2f, 1e-3f); // facets lie up to 0.8 mm beneath the sphere
    }
}

TEST(SkinGap, FollowingFindsWhatSearchingFinds) {
    Body body;
    auto cloth = test::sphere(0.23f, 3);
    SkinGap followed(body.mesh.triangles, body.mesh.positions.size(), cloth.positions.size());
    followed.find(body.skin(), cloth.positions);
    SkinGap searched = followed;
    const Mat3f turn = Eigen::AngleAxisf(0.05f, Vec3f::UnitY()).toRotationMatrix();
    for (int frame = 0; frame < 20; ++frame) {
        for (Vec3f& p : cloth.positions)
            p = 1.005f * (turn * p);
        for (Vec3f& p : body.mesh.positions)
            p.x() *= 1.01f;
        body.mesh.normals.resize(body.mesh.positions.size());
        geometry::vertex_normals(body.mesh.positions, body.mesh.triangles, body.mesh.normals);
        followed.follow(body.skin(), cloth.positions);
        searched.find(body.skin(), cloth.positions);
        for (std::size_t v = 0; v < cloth.positions.size(); ++v)
            EXPECT_NEAR(followed.gaps()[v], searched.gaps()[v], 1e-6f);
    }
}

TEST(SkinGap, OtherCountsAreRefused) {
    const Body body;
    const auto cloth = test::sphere(0.23f, 2);
    SkinGap gap(body.mesh.triangles, body.mesh.positions.size(), cloth.positions.size() + 1);
    EXPECT_THROW(gap.find(body.skin(), cloth.positions), Error);
}

} // namespace
} // namespace toile::garment
