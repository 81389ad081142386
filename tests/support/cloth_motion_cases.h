// How cloth moves by closed forms, for every cloth plugin. Included after a plugin's scenes.h,
// which names the plugin and has `free_fall` and `finely`, the settings of a test that wants small
// steps.
#pragma once

#include <gtest/gtest.h>
#include <numbers>

namespace toile::TOILE_CLOTH_PLUGIN::test {
namespace {

/// Holds the top row of a sheet made by `sheet` with nu quads across.
std::vector<float> top_held(const Mesh& mesh, std::uint32_t nu) {
    std::vector<float> held(mesh.positions.size(), 0.0f);
    std::fill(held.end() - (nu + 1), held.end(), 1.0f);
    return held;
}

// A stiff strip of length L swings like a rod: T = 2 pi sqrt(2 L / (3 g)).
TEST(Motion, StripSwingsWithTheRodsPeriod) {
    const float length = 0.3f;
    const float angle = 0.15f;
    const Vec3f down(std::sin(angle) * length, -std::cos(angle) * length, 0.0f);
    Mesh mesh = sheet(Vec3f(0, 1, -0.02f) + down, {0, 0, 0.04f}, -down, 2, 12);
    Fabric fabric;
    fabric.bend_warp = fabric.bend_weft = 0.05f; // a rod, not a whip
    fabric.stretch_warp = fabric.stretch_weft = 5000.0f;
    Stage stage(far_away(), mesh, finely(free_fall()), fabric, top_held(mesh, 2));
    std::vector<double> crossings;
    float before = stage.positions[1].x();
    const double dt = 1.0 / 120.0;
    for (int i = 0; i < 480 && crossings.size() < 3; ++i) {
        ASSERT_EQ(stage.step(dt), StepResult::ok);
        const float now = stage.positions[1].x();
        if ((before > 0.0f) != (now > 0.0f)) {
            crossings.push_back((i - double(now / (now - before))) * dt);
        }
        before = now;
    }
    ASSERT_EQ(crossings.size(), 3u);
    const double expected = 2.0 * std::numbers::pi * std::sqrt(2.0 * length / (3.0 * 9.81));
    EXPECT_NEAR(crossings[2] - crossings[0], expected, 0.05 * expected);
}

TEST(Motion, FreeClothFalls) {
    const Mesh mesh = sheet({0, 1, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, 4, 4);
    Stage stage(far_away(), mesh, free_fall());
    for (int i = 0; i < 15; ++i) {
        stage.step();
    }
    EXPECT_NEAR(stage.positions[0].y(), 1.0 - 0.5 * 9.81 * 0.25, 0.01);
}

} // namespace
} // namespace toile::TOILE_CLOTH_PLUGIN::test
