// What a tube over another hides.
#include "garment/hidden.h"

#include "geometry/mesh.h"
#include "geometry/nearest_surface.h"
#include "support/garments.h"
#include "support/meshes.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace toile::garment {
namespace {

struct Tube {
    GarmentSize size;
    std::vector<Vec3f> normals;
    Tube(float radius, float low, float high)
        : size(test::tube_size("M", radius, low, high, 36, 40)) {
        normals.resize(size.simulation.positions.size());
        geometry::vertex_normals(size.simulation.positions, size.simulation.triangles, normals);
    }
    [[nodiscard]] ClothSurface surface() const {
        return {size.simulation.positions, size.simulation.triangles};
    }
    [[nodiscard]] float height(std::size_t triangle) const {
        float low = 10.0f;
        for (const std::uint32_t v : size.simulation.triangles[triangle])
            low = std::min(low, size.simulation.positions[v].y());
        return low;
    }
};

/// A pillar that fills the tubes.
geometry::TriangleMesh pillar() {
    return test::box({-0.12f, 0.0f, -0.12f}, {0.12f, 1.4f, 0.12f});
}

std::vector<std::uint8_t> hidden(const Tube& inner, std::span<const ClothSurface> over,
                                 float margin_m) {
    const auto body = pillar();
    HiddenOptions options;
    options.margin_m = margin_m;
    return hidden_triangles(inner.surface(), inner.normals, over, {body.positions, body.triangles},
                            options);
}

TEST(Hidden, TheMiddleUnderALongTubeIsHiddenAndItsBordersAreNot) {
    const Tube inner(0.20f, 0.3f, 1.1f), outer(0.206f, 0.2f, 1.2f);
    const ClothSurface over = outer.surface();
    const auto found = hidden(inner, std::span(&over, 1), 0.0f);
    std::size_t middle = 0, away = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const bool in_middle = inner.height(i) > 0.6f && inner.height(i) < 0.8f;
        middle += in_middle ? 1 : 0;
        away += in_middle && found[i] != 0 ? 1 : 0;
    }
    EXPECT_GT(middle, 100u);
    EXPECT_EQ(away, middle);
}

TEST(Hidden, WhatReachesBeyondTheOuterHemStaysAndAMarginBesideIt) {
    const Tube inner(0.20f, 0.3f, 1.1f), outer(0.206f, 0.6f, 1.3f);
    const ClothSurface over = outer.surface();
    const auto close = hidden(inner, std::span(&over, 1), 0.0f);
    const auto wide = hidden(inner, std::span(&over, 1), 0.15f);
    std::size_t less = 0, more = 0;
    for (std::size_t i = 0; i < close.size(); ++i) {
        if (inner.height(i) < 0.6f) {
            EXPECT_EQ(close[i], 0) << "bare of the outer one";
        }
        if (inner.height(i) < 0.75f) {
            EXPECT_EQ(wide[i], 0) << "within the margin";
        }
        EXPECT_LE(wide[i], close[i]);
        less += close[i];
        more += wide[i];
    }
    EXPECT_GT(more, 0u);
    EXPECT_GT(less, more);
}

TEST(Hidden, NoCameraAroundSeesWhatIsHidden) {
    const Tube inner(0.20f, 0.3f, 1.1f), outer(0.21f, 0.6f, 1.3f);
    const ClothSurface over = outer.surface();
    const auto found = hidden(inner, std::span(&over, 1), HiddenOptions().margin_m);
    ASSERT_GT(std::count(found.begin(), found.end(), 1), 100);
    // Whatever stands between: the outer tube, the inner one, the pillar.
    const auto body = pillar();
    const std::vector<ClothSurface> all = {over, inner.surface(), {body.positions, body.triangles}};
    std::vector<geometry::NearestSurface> screens;
    for (const ClothSurface& surface : all)
        screens.emplace_back(surface.positions, surface.triangles);
    for (const Vec3f& camera : test::sphere(3.0f, 2).positions) {
        const Vec3f from = camera + Vec3f(0.0f, 0.8f, 0.0f);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i] == 0) continue;
            const Triangle& t = inner.size.simulation.triangles[i];
            Vec3f centre = Vec3f::Zero();
            for (const std::uint32_t v : t)
                centre += inner.size.simulation.positions[v] / 3.0f;
            if (inner.normals[t[0]].dot(from - centre) < 0.0f) continue; // its inside
            EXPECT_TRUE(std::any_of(screens.begin(), screens.end(),
                                    [&](const auto& screen) {
                                        return screen.blocked(from, centre - from, 0.0f, 0.999f);
                                    }))
                << "triangle " << i << " from " << from.transpose();
        }
    }
}

TEST(Hidden, UnderAWideTubeOneSeesUpFromBelow) {
    // The outer tube stands 20 cm off: rays leave beneath its hem from far up.
    const Tube inner(0.20f, 0.3f, 1.1f), outer(0.40f, 0.3f, 1.3f);
    const ClothSurface over = outer.surface();
    const auto found = hidden(inner, std::span(&over, 1), 0.0f);
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), 0);
}

TEST(Hidden, WithNothingOverItNothingIsHidden) {
    const Tube inner(0.20f, 0.3f, 1.1f);
    const auto found = hidden(inner, {}, 0.0f);
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), 0);
}

} // namespace
} // namespace toile::garment
