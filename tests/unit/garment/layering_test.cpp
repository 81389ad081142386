#include "garment/layering.h"

#include "support/meshes.h"

#include <gtest/gtest.h>

namespace toile::garment {
namespace {

constexpr float kGap = 0.004f;

// A skirt of radius 0.2 and a shirt of another radius over its upper half.
struct Layers {
    geometry::TriangleMesh inner = test::tube(0.2f, 0.2f, 0.5f, 48, 20);
    geometry::TriangleMesh outer;
    explicit Layers(float radius) : outer(test::tube(radius, radius, 0.5f, 48, 20)) {
        inner.normals.resize(inner.positions.size());
        geometry::vertex_normals(inner.positions, inner.triangles, inner.normals);
        for (Vec3f& p : outer.positions)
            p.y() += 0.25f;
    }
    [[nodiscard]] LayerOffset pair() const {
        return {{inner.positions, inner.triangles}, {outer.positions, outer.triangles}};
    }
};

float radius(const Vec3f& p) {
    return Vec2f(p.x(), p.z()).norm();
}

TEST(Layering, AShirtBoundInsideTheSkirtComesOutOfIt) {
    Layers layers(0.18f);
    LayerOffset offset = layers.pair();
    ASSERT_GT(offset.sample_count(), 0u);
    offset.apply(layers.inner.positions, layers.inner.normals, kGap, layers.outer.positions);
    for (const Vec3f& p : layers.outer.positions) {
        if (p.y() < 0.49f) {
            EXPECT_GE(radius(p), 0.2f + kGap - 1e-3f) << p.transpose();
        } else if (p.y() > 0.57f) {
            EXPECT_NEAR(radius(p), 0.18f, 1e-3f) << "beyond the skirt's border it is free";
        }
    }
}

TEST(Layering, WhatIsOutsideAlreadyStaysBitForBit) {
    Layers layers(0.23f);
    const auto before = layers.outer.positions;
    LayerOffset offset = layers.pair();
    offset.apply(layers.inner.positions, layers.inner.normals, kGap, layers.outer.positions);
    EXPECT_TRUE(before == layers.outer.positions);
}

TEST(Layering, ThePushFollowsTheInnerGarment) {
    Layers layers(0.21f);
    LayerOffset offset = layers.pair();
    for (Vec3f& p : layers.inner.positions) {
        p.x() *= 1.2f;
        p.z() *= 1.2f;
    }
    offset.apply(layers.inner.positions, layers.inner.normals, kGap, layers.outer.positions);
    for (const Vec3f& p : layers.outer.positions) {
        if (p.y() < 0.49f) {
            EXPECT_GE(radius(p), 0.24f + kGap - 2e-3f);
        }
    }
}

TEST(Layering, ThePushIsThatOfWhereTheClothSlidTo) {
    // The skirt turns beneath the shirt, and is dented where it came to.
    Layers layers(0.23f);
    LayerOffset offset = layers.pair();
    constexpr int kFrames = 30;
    const auto start = layers.inner.positions;
    for (int frame = 1; frame <= kFrames; ++frame) {
        const float turn = 2.0f * static_cast<float>(frame) / kFrames;
        for (std::size_t v = 0; v < start.size(); ++v)
            layers.inner.positions[v] = Eigen::AngleAxisf(turn, Vec3f::UnitY()) * start[v];
        for (Vec3f& p : layers.inner.positions)
            p.z() *= p.z() > 0.0f ? 1.3f : 1.0f;
        geometry::vertex_normals(layers.inner.positions, layers.inner.triangles,
                                 layers.inner.normals);
        Layers fresh(0.23f);
        layers.outer.positions = fresh.outer.positions;
        offset.apply(layers.inner.positions, layers.inner.normals, kGap, layers.outer.positions);
    }
    const geometry::NearestSurface inner(layers.inner.positions, layers.inner.triangles);
    for (const Vec3f& p : layers.outer.positions) {
        if (p.y() < 0.48f) {
            EXPECT_GT(inner.nearest(p).signed_distance, 0.5f * kGap) << p.transpose();
        }
    }
}

} // namespace
} // namespace toile::garment
